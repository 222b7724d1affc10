// SPDX-License-Identifier: Apache-2.0
#include "core/edit/profile.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/edit/spot.hpp"
#include "core/edit/way_in.hpp"
#include "core/integrate/distance.hpp"
#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

using enum Orientation;

/// Walks the segments one after the other. All decisions on one are by orientations against its
/// own two ends, never against a crossing, which is rounded.
class ProfileWalk {
  public:
    ProfileWalk(const Tin& tin, const ProfileLimits& limits) : tin_(tin), limits_(limits) {}

    Result<Profile> run(std::span<const Point2> line) {
        Location here = locate(tin_, line[0], tin_.hint(line[0]));
        if (here.kind != Location::Kind::Outside) {
            begin();
            add_input(here, line[0]);
        }
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (line[i] == line[i - 1]) continue;
            here = walk(line[i - 1], line[i], here);
            if (!is_within_limits()) return *std::move(refused_);
        }
        return std::move(profile_);
    }

  private:
    /// Goes from p, where `here` is, to q, and tells what is at q.
    Location walk(Point2 p, Point2 q, const Location& here) {
        p_ = p;
        q_ = q;
        start_ = profile_.length;
        length_ = distance_between(p, q);
        profile_.length += length_;
        arrived_.reset();
        left_by_.reset();
        go(depart(here));
        if (!arrived_ && !refused_) come_in_again(here.kind != Location::Kind::Outside);
        if (arrived_) return *arrived_;
        if (refused_) return {};
        const Location end = locate(tin_, q, tin_.hint(q));
        if (end.kind != Location::Kind::Outside) {  // touched from outside
            begin();
            add_input(end, q);
        }
        return end;
    }

    /// Each way in that is not before the place where the line went out last.
    void come_in_again(bool on_mesh_at_p) {
        for (const BoundaryContact& way : ways_in(tin_, p_, q_)) {
            if (left_by_ && (way == *left_by_ || is_before(tin_, p_, q_, way, *left_by_))) continue;
            if (!on_mesh_at_p || !starts_at_p(way)) {
                begin();
                add_contact(way);
            }
            go(way.is_vertex() ? Next{Next::Kind::FromVertex, {}, way.vertex}
                               : Next{Next::Kind::Into, way.side});
            if (arrived_ || refused_) return;
        }
    }

    bool starts_at_p(const BoundaryContact& way) const {
        if (way.is_vertex()) return tin_.plan(way.vertex) == p_;
        return orientation(tin_.plan(tin_.origin(way.side)), tin_.plan(tin_.destination(way.side)),
                           p_) == Collinear;
    }

    /// What the walk does next.
    struct Next {
        enum class Kind : std::uint8_t {
            Nothing,     ///< it has arrived, or is out of the mesh
            FromVertex,  ///< it is at the vertex
            Into,  ///< into the side's triangle across the side, which runs from the left of the
                   ///< line to its right
            Over,  ///< out of the side's triangle across the side
        };
        Kind kind = Kind::Nothing;
        Side side = {};
        VertexId vertex = {};
    };

    /// Ends because every step is farther along the segment, or within the next triangle.
    void go(Next next) {
        while (next.kind != Next::Kind::Nothing && going()) {
            switch (next.kind) {
                case Next::Kind::Nothing:
                    break;
                case Next::Kind::FromVertex:
                    next = from_vertex(next.vertex);
                    break;
                case Next::Kind::Into:
                    next = enter(next.side);
                    break;
                case Next::Kind::Over:
                    next = cross(next.side);
                    break;
            }
        }
    }

    Next depart(const Location& here) {
        switch (here.kind) {
            case Location::Kind::Outside:
                break;
            case Location::Kind::OnVertex:
                return {Next::Kind::FromVertex, {}, here.vertex};
            case Location::Kind::OnEdge:
                return from_edge(here.side);
            case Location::Kind::InTriangle:
                return from_inside(here.side.triangle());
        }
        return {};
    }

    Next from_inside(TriangleId t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(t, i);
            const VertexId right = tin_.origin(side);
            const Orientation of_right = turn(right);
            if (of_right == Collinear && is_ahead(p_, q_, tin_.plan(right)))
                return reach(right, side);
            if (of_right == Clockwise && turn(tin_.destination(side)) == CounterClockwise)
                return {Next::Kind::Over, side};
        }
        return {};
    }

    Next from_edge(Side side) {
        const Point2 a = tin_.plan(tin_.origin(side)), b = tin_.plan(tin_.destination(side));
        const Orientation of_q = orientation(a, b, q_);
        if (of_q == Collinear)
            return reach(is_ahead(p_, q_, b) ? tin_.destination(side) : tin_.origin(side), side);
        const Side entry = of_q == CounterClockwise ? side : tin_.twin(side);
        if (!entry.valid()) return {};  // out of the mesh at once
        return {Next::Kind::Into, entry};
    }

    Next from_vertex(VertexId v) {
        const Departure way = leave(tin_, v, q_, side_from(tin_, v));
        if (way.kind == Departure::Kind::Outside) {
            left_by_ = BoundaryContact{{}, v};
            return {};
        }
        if (way.kind == Departure::Kind::AlongEdge) return reach(way.along(tin_, v), way.side);
        touch(way.side.triangle());
        return {Next::Kind::Over, way.side};
    }

    /// In the side's triangle, a vertex of which is straight ahead.
    Next reach(VertexId v, Side side) {
        touch(side.triangle());
        if (arrives_before(v)) {
            arrive(locate_in(side.triangle()));
            return {};
        }
        add_vertex(v, side.triangle());
        return {Next::Kind::FromVertex, {}, v};
    }

    Next enter(Side entry) {
        touch(entry.triangle());
        const VertexId apex = tin_.apex(entry);
        const Orientation of_apex = turn(apex);
        if (of_apex == Collinear) return reach(apex, entry);
        return {Next::Kind::Over, of_apex == CounterClockwise ? entry.next() : entry.previous()};
    }

    Next cross(Side exit) {
        const Point2 right = tin_.plan(tin_.origin(exit)), left = tin_.plan(tin_.destination(exit));
        if (orientation(right, left, q_) != Clockwise) {
            arrive(locate_in(exit.triangle()));
            return {};
        }
        const Side entry = tin_.twin(exit);
        add_crossing(exit, entry.valid() ? entry.triangle() : exit.triangle());
        if (entry.valid()) return {Next::Kind::Into, entry};
        left_by_ = BoundaryContact{exit, {}};
        return {};
    }

    Orientation turn(VertexId v) const { return orientation(p_, q_, tin_.plan(v)); }
    /// Whether q comes strictly before the vertex, which is on the line ahead.
    bool arrives_before(VertexId v) const {
        return tin_.plan(v) != q_ && is_ahead(tin_.plan(v), p_, q_);
    }

    /// Where q is in a closed triangle, or on an edge.
    Location locate_in(TriangleId t) const {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(t, i);
            if (tin_.plan(tin_.origin(side)) == q_)
                return {Location::Kind::OnVertex, {}, tin_.origin(side)};
            if (orientation(tin_.plan(tin_.origin(side)), tin_.plan(tin_.destination(side)), q_) ==
                    Collinear &&
                tin_.plan(tin_.destination(side)) != q_)
                return locate_on(side);
        }
        return {Location::Kind::InTriangle, {t, 0}, {}};
    }
    Location locate_on(Side side) const {
        const Side twin = tin_.twin(side);
        return {Location::Kind::OnEdge, twin.valid() ? std::min(side, twin) : side, {}};
    }

    void arrive(const Location& at) {
        arrived_ = at;
        add_input(at, q_);
    }

    bool going() { return !arrived_ && is_within_limits(); }

    bool is_within_limits() {
        constexpr std::uint64_t kStepsBetweenQuestions = 1024;
        if (refused_) return false;
        if (profile_.crossings > limits_.max_crossings) {
            refused_ = Error{ErrorCode::CrossingBudget,
                             "the line crosses more than " + std::to_string(limits_.max_crossings) +
                                 " edges; ask for parts of it",
                             {}};
        } else if (steps_++ % kStepsBetweenQuestions == 0 && limits_.cancelled &&
                   limits_.cancelled()) {
            refused_ = Error{ErrorCode::Cancelled, "the profile was stopped", {}};
        }
        return !refused_;
    }

    void begin() { profile_.stretches.emplace_back(); }
    /// The triangle by which the line goes on from the newest point.
    void touch(TriangleId t) { profile_.stretches.back().points.back().triangle = t; }

    void add(double distance, Point3 position, TriangleId t, ProfilePoint::Kind kind) {
        auto& points = profile_.stretches.back().points;
        distance = std::clamp(distance, start_, start_ + length_);
        if (!points.empty()) distance = std::max(distance, points.back().distance);
        points.push_back({distance, position, t, kind});
        if (kind != ProfilePoint::Kind::Input) ++profile_.crossings;
    }
    void add_input(const Location& at, Point2 p) {
        const Spot spot = spot_of(tin_, at, p);
        add(profile_.length, {p.x, p.y, spot.elevation}, spot.triangle, ProfilePoint::Kind::Input);
    }
    void add_vertex(VertexId v, TriangleId t) {
        if (tin_.plan(v) == q_) return arrive({Location::Kind::OnVertex, {}, v});
        add(start_ + distance_between(p_, tin_.plan(v)), tin_.vertex(v).point(), t,
            ProfilePoint::Kind::Vertex);
    }
    void add_crossing(Side side, TriangleId t) {
        const Tin::Vertex& a = tin_.vertex(tin_.origin(side));
        const Tin::Vertex& b = tin_.vertex(tin_.destination(side));
        const double along = crossing_share(p_, q_, a.plan(), b.plan());
        const double share = crossing_share(a.plan(), b.plan(), p_, q_);
        add(start_ + along * length_,
            {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share}, t,
            ProfilePoint::Kind::Edge);
    }
    void add_contact(const BoundaryContact& way) {
        if (way.is_vertex())
            add_vertex(way.vertex, tin_.vertex(way.vertex).triangle);
        else
            add_crossing(way.side, way.side.triangle());
    }

    const Tin& tin_;
    const ProfileLimits& limits_;
    Profile profile_;
    Point2 p_, q_;
    double start_ = 0.0;   ///< distance of p
    double length_ = 0.0;  ///< of the segment
    std::uint64_t steps_ = 0;
    std::optional<Location> arrived_;
    std::optional<BoundaryContact> left_by_;  ///< where the line went out of the mesh last
    std::optional<Error> refused_;
};

std::optional<Error> fault_of(std::span<const Point2> line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (in_coordinate_range(line[i].x) && in_coordinate_range(line[i].y)) continue;
        ErrorPlace place;
        place.point = i;
        return Error{ErrorCode::CoordinateOutOfRange, "the coordinate is out of range", place};
    }
    const bool moves = std::any_of(line.begin(), line.end(),
                                   [&](const Point2& p) { return !(p == line.front()); });
    if (moves) return std::nullopt;
    return Error{ErrorCode::LineTooShort, "a line needs two different positions", {}};
}

}  // namespace

Result<Profile> profile_along(const Tin& tin, std::span<const Point2> line,
                              const ProfileLimits& limits) {
    if (auto fault = fault_of(line)) return *std::move(fault);
    return ProfileWalk(tin, limits).run(line);
}

}  // namespace tinsmith::core
