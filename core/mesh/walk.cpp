// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/walk.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/predicates/orientation.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

using enum Orientation;

/// Position relative to a closed triangle, by exact predicates; Outside where it is not in it.
Location locate_in(const Tin& tin, TriangleId t, Point2 p) {
    const auto& vertices = tin.triangle(t).vertices;
    unsigned on_side = 3;
    for (unsigned i = 0; i < 3; ++i) {
        if (tin.plan(vertices[i]) == p) return {Location::Kind::OnVertex, {}, vertices[i]};
        switch (orientation(tin.plan(vertices[i]), tin.plan(vertices[Side::next_of(i)]), p)) {
            case Clockwise:
                return {};
            case Collinear:
                on_side = i;
                break;
            case CounterClockwise:
                break;
        }
    }
    if (on_side == 3) return {Location::Kind::InTriangle, {t, 0}, {}};
    const Side side(t, on_side);
    const Side twin = tin.twin(side);
    return {Location::Kind::OnEdge, twin.valid() ? std::min(side, twin) : side, {}};
}

/// The vertex of the same position with the lowest id, where fans touch in one point: so that the
/// answer does not depend on the way. Such vertices are on the boundary, each starting an edge.
Location canonical(const Tin& tin, Location found) {
    if (found.kind != Location::Kind::OnVertex) return found;
    if (!boundary_side_from(tin, found.vertex).valid()) return found;
    const Point2 p = tin.plan(found.vertex);
    for (const VertexId v : tin.boundary().near(p, p))
        if (v.index() < tin.vertex_count() && v < found.vertex && tin.plan(v) == p)
            found.vertex = v;
    return found;
}

/// The straight walk from a vertex to p. Gives up, with `arrived` false, where the line leaves
/// the mesh. Ends because every step is strictly nearer to p along one line.
struct StraightWalk {
    bool arrived = false;
    Location location;
};

StraightWalk walk_straight(const Tin& tin, VertexId v, Point2 p) {
    while (true) {
        if (tin.plan(v) == p) return {true, {Location::Kind::OnVertex, {}, v}};
        const Point2 from = tin.plan(v);
        const Departure departure = leave(tin, v, p, side_from(tin, v));
        if (departure.kind == Departure::Kind::Outside) return {};
        if (departure.kind == Departure::Kind::AlongEdge) {
            const VertexId next = departure.along(tin, v);
            // p lies on the edge unless it is at or past its far end.
            if (!is_ahead(tin.plan(next), from, p))
                v = next;
            else
                return {true, locate_in(tin, departure.side.triangle(), p)};
            continue;
        }
        // Through triangles, until p is in one or the line meets a vertex.
        Side exit = departure.side;
        VertexId met;
        while (!met.valid()) {
            const Point2 right = tin.plan(tin.origin(exit));
            const Point2 left = tin.plan(tin.destination(exit));
            if (orientation(right, left, p) == Clockwise) {
                const Side entry = tin.twin(exit);
                if (!entry.valid()) return {};
                const VertexId apex = tin.apex(entry);
                switch (orientation(from, p, tin.plan(apex))) {
                    case Collinear:
                        if (is_ahead(tin.plan(apex), from, p))
                            return {true, locate_in(tin, entry.triangle(), p)};
                        met = apex;
                        break;
                    // entry runs left -> right; next is right -> apex, previous apex -> left.
                    case CounterClockwise:
                        exit = entry.next();
                        break;
                    case Clockwise:
                        exit = entry.previous();
                        break;
                }
                continue;
            }
            return {true, locate_in(tin, exit.triangle(), p)};
        }
        v = met;
    }
}

/// Where the ray to +x from a position crosses the boundary.
struct RayCrossing {
    double x;
    Side side;
};

/// Looks for the position from the boundary east of it.
class BoundaryLook {
  public:
    BoundaryLook(const Tin& tin, Point2 p) : tin_(tin), p_(p) {}

    Location locate() {
        const double width = tin_.bounds().max.x - tin_.bounds().min.x;
        const double far = std::max(tin_.bounds().max.x, p_.x);
        // A little way first, and then four times as far each time: the nearest crossing tells, and
        // what lies beyond it costs nothing. Ends after the factor's logarithm of the width.
        // NOLINTNEXTLINE(cert-flp30-c): it grows by a factor, nothing is counted
        for (double reach = width / 256.0; p_.x + reach < far; reach *= 4.0) {
            look(p_.x + reach);
            if (found_.kind != Location::Kind::Outside) return found_;
            if (!nearest_tells(p_.x + reach)) continue;
            return is_way_in(crossings_.front().side) ? walk_back() : Location{};
        }
        look(far);
        if (found_.kind != Location::Kind::Outside) return found_;
        return crossings_.size() % 2 == 0 ? Location{} : walk_back();
    }

  private:
    /// Collects the crossings up to x in order, half-open in y so that no vertex counts twice.
    void look(double x) {
        crossings_.clear();
        for (const VertexId v : tin_.boundary().near(p_, {x, p_.y})) {
            if (v.index() >= tin_.vertex_count()) continue;
            const Side side = boundary_side_from(tin_, v);
            if (!side.valid()) continue;
            const Point2 a = tin_.plan(v);
            const Point2 b = tin_.plan(tin_.destination(side));
            found_ = locate_in(tin_, side.triangle(), p_);
            if (found_.kind != Location::Kind::Outside) return;
            if ((a.y > p_.y) == (b.y > p_.y)) continue;
            const Orientation turn = orientation(a, b, p_);
            if ((b.y > a.y) != (turn == CounterClockwise)) continue;  // crosses to the west of p
            crossings_.push_back({a.x + (b.x - a.x) * ((p_.y - a.y) / (b.y - a.y)), side});
        }
        std::sort(crossings_.begin(), crossings_.end(),
                  [](const RayCrossing& l, const RayCrossing& r) {
                      return l.x != r.x ? l.x < r.x : l.side < r.side;
                  });
    }

    /// Whether all crossings as near as the first are known, and it alone is that near: those
    /// within rounding of each other can be in any order.
    bool nearest_tells(double x) const {
        if (crossings_.empty()) return false;
        const Bounds& box = tin_.bounds();
        const double largest = std::max(std::fabs(box.min.x), std::fabs(box.max.x));
        const double clear = crossings_.front().x + 64.0 * ulp(largest);
        return clear < x && (crossings_.size() == 1 || clear < crossings_[1].x);
    }

    /// Whether the mesh is on the west of the boundary side, which the ray crosses: it is on its
    /// left.
    bool is_way_in(Side side) const { return tin_.plan(tin_.origin(side)).y <= p_.y; }

    /// From the nearest crossing back along the ray. Rounding can misplace crossings within a few
    /// ulps of each other, so a walk that runs out of the mesh leaves its turn to the next.
    Location walk_back() const {
        for (const RayCrossing& crossing : crossings_) {
            Side exit = crossing.side;
            while (exit.valid()) {
                const Location here = locate_in(tin_, exit.triangle(), p_);
                if (here.kind != Location::Kind::Outside) return here;
                // On through the other side that the ray crosses: vertices at its height are below.
                const bool apex_above = tin_.plan(tin_.apex(exit)).y > p_.y;
                const bool origin_above = tin_.plan(tin_.origin(exit)).y > p_.y;
                exit = tin_.twin(apex_above == origin_above ? exit.next() : exit.previous());
            }
        }
        return {};
    }

    const Tin& tin_;
    Point2 p_;
    std::vector<RayCrossing> crossings_;
    Location found_;
};

}  // namespace

Side side_from(const Tin& tin, TriangleId t, VertexId v) {
    const auto& vertices = tin.triangle(t).vertices;
    return {t, vertices[0] == v ? 0U : vertices[1] == v ? 1U : 2U};
}

namespace {

/// Turns around a vertex, counter-clockwise to the border or once around, then clockwise from the
/// start to the border's other side. At each stop looks at a triangle's two sides at the vertex.
class Turn {
  public:
    Turn(const Tin& tin, VertexId v) : tin_(tin), start_(side_from(tin, v)), at_(start_) {}

    bool ended() const { return !at_.valid(); }
    /// The side that joins the vertex and w, of the triangle it looks at; invalid for none.
    Side joining(VertexId w) const {
        if (tin_.destination(at_) == w) return at_;
        return tin_.apex(at_) == w ? at_.previous() : Side{};
    }
    void step() {
        if (!clockwise_) {
            at_ = tin_.twin(at_.previous());
            if (at_ == start_)
                at_ = {};
            else if (!at_.valid()) {
                clockwise_ = true;
                at_ = start_;
            } else
                return;
            if (!at_.valid()) return;
        }
        at_ = tin_.twin(at_);
        if (at_.valid()) at_ = at_.next();
    }

  private:
    const Tin& tin_;
    Side start_;
    Side at_;
    bool clockwise_ = false;
};

}  // namespace

Side find_edge(const Tin& tin, VertexId v, VertexId w) {
    // From both ends in turn: an edge may join a vertex of three triangles to one of thousands.
    Turn at_v(tin, v), at_w(tin, w);
    while (!at_v.ended() && !at_w.ended()) {
        if (const Side side = at_v.joining(w); side.valid()) return side;
        if (const Side side = at_w.joining(v); side.valid()) return side;
        at_v.step();
        at_w.step();
    }
    return {};
}

Side boundary_side_from(const Tin& tin, VertexId v) {
    const Side start = side_from(tin, v);
    Side s = start;
    while (true) {  // clockwise
        const Side twin = tin.twin(s);
        if (!twin.valid()) return s;
        s = twin.next();
        if (s == start) return {};
    }
}

Departure leave(const Tin& tin, VertexId v, Point2 target, Side start) {
    const Point2 from = tin.plan(v);
    const auto is_on_way = [&](Orientation turn, VertexId w) {
        return turn == Collinear && is_ahead(from, target, tin.plan(w));
    };
    Side s = start;
    const Orientation first = orientation(from, target, tin.plan(tin.destination(s)));
    if (is_on_way(first, tin.destination(s))) return {Departure::Kind::AlongEdge, s};
    Orientation right = first;
    do {  // counter-clockwise
        const VertexId apex = tin.apex(s);
        const Orientation left = orientation(from, target, tin.plan(apex));
        if (is_on_way(left, apex)) return {Departure::Kind::AlongEdge, s.previous()};
        if (right == Clockwise && left == CounterClockwise)
            return {Departure::Kind::ThroughEdge, s.next()};
        right = left;
        s = tin.twin(s.previous());
    } while (s.valid() && s != start);
    if (s.valid()) return {Departure::Kind::Outside, {}};

    Orientation left = first;  // the rest of an open fan, clockwise
    for (s = tin.twin(start); s.valid(); s = tin.twin(s)) {
        s = s.next();
        const VertexId w = tin.destination(s);
        right = orientation(from, target, tin.plan(w));
        if (is_on_way(right, w)) return {Departure::Kind::AlongEdge, s};
        if (right == Clockwise && left == CounterClockwise)
            return {Departure::Kind::ThroughEdge, s.next()};
        left = right;
    }
    return {Departure::Kind::Outside, {}};
}

Location locate(const Tin& tin, Point2 p, TriangleId seed) {
    const Bounds& box = tin.bounds();
    // Splits on the boundary may round past the box by an ulp; those are found from the boundary.
    if (p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y) {
        const StraightWalk walk = walk_straight(tin, tin.triangle(seed).vertices[0], p);
        if (walk.arrived) return canonical(tin, walk.location);
    }
    return canonical(tin, BoundaryLook(tin, p).locate());
}

}  // namespace tinsmith::core
