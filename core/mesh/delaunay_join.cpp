// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/delaunay_join.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/predicates/in_circle.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ids.hpp"

namespace tinsmith::core {

namespace {

using enum Orientation;
constexpr std::uint32_t kGhost = GrowingDelaunay::kGhost;

/// A hull, counter-clockwise: edge i runs from vertex i to the next, and has the ghost outside.
class Hull {
  public:
    using Triangle = GrowingDelaunay::Triangle;

    Hull(std::span<const Triangle> triangles, std::uint32_t ghost) {
        const std::uint32_t first = ghost;
        do {
            const Triangle& t = triangles[ghost];
            const unsigned k = ghost_corner(t);
            vertices_.push_back(t.vertices[Side::previous_of(k)]);
            ghosts_.push_back(ghost);
            ghost = t.twins[k] >> 2;
        } while (ghost != first);
    }

    /// Which of the ghost's vertices is none. After it come the edge's end and its origin.
    static unsigned ghost_corner(const Triangle& t) {
        return t.vertices[0] == kGhost ? 0 : t.vertices[1] == kGhost ? 1 : 2;
    }

    std::size_t next(std::size_t i) const { return i + 1 == vertices_.size() ? 0 : i + 1; }
    std::size_t previous(std::size_t i) const { return i == 0 ? vertices_.size() - 1 : i - 1; }
    std::uint32_t vertex(std::size_t i) const { return vertices_[i]; }
    std::uint32_t ghost(std::size_t edge) const { return ghosts_[edge]; }
    std::size_t size() const { return vertices_.size(); }

  private:
    std::vector<std::uint32_t> vertices_;
    std::vector<std::uint32_t> ghosts_;
};

/// Where a line touches both hulls, by their vertices.
struct Tangent {
    std::size_t low;
    std::size_t high;
};

//                 upper tangent
//        .------ l -------------- h ------.      seen with the axis to the right: the lower half
//       /  lower  \     gap      / higher  \     is on the left; the gap is filled from the lower
//       \   half   | l'      h' |   half   /     tangent up, each triangle on an edge l -> l' of
//        '------- l ------------ h -------'      the one hull or h' -> h of the other
//                 lower tangent
class Seam {
  public:
    Seam(const DelaunayHalves& halves, std::size_t most_swaps)
        : points_(halves.points),
          triangles_(halves.triangles),
          axis_(halves.axis),
          low_(halves.triangles, ghost_in(0, halves.lower_end)),
          high_(halves.triangles, ghost_in(halves.lower_end, halves.triangles.size() - 2)),
          left_(most_swaps) {}

    bool close() {
        const Tangent bottom = tangent(Clockwise), top = tangent(CounterClockwise);
        fill(bottom, top);
        return swap_all();
    }

  private:
    using Triangle = GrowingDelaunay::Triangle;

    std::uint32_t ghost_in(std::size_t begin, std::size_t end) const {
        std::size_t t = begin;
        while (t + 1 < end && !triangles_[t].is_ghost())
            ++t;
        return static_cast<std::uint32_t>(t);
    }

    Point2 low(std::size_t i) const { return points_[low_.vertex(i)]; }
    Point2 high(std::size_t i) const { return points_[high_.vertex(i)]; }

    /// The vertex of the hull that is farthest along the axis, or least far.
    std::size_t extreme(const Hull& hull, bool is_farthest) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < hull.size(); ++i) {
            const double there = along(axis_, points_[hull.vertex(i)]);
            const double known = along(axis_, points_[hull.vertex(best)]);
            if (is_farthest ? there > known : there < known) best = i;
        }
        return best;
    }

    /// The common tangent that has nothing of either hull on the given side. Of several vertices on
    /// it those that see each other.
    Tangent tangent(Orientation side) const {
        Tangent at{extreme(low_, true), extreme(high_, false)};
        const bool is_bottom = side == Clockwise;
        const auto on_low = [&](std::size_t i) {
            return is_bottom ? low_.previous(i) : low_.next(i);
        };
        const auto on_high = [&](std::size_t i) {
            return is_bottom ? high_.next(i) : high_.previous(i);
        };
        while (true) {
            const std::size_t l = on_low(at.low), h = on_high(at.high);
            if (orientation(low(at.low), high(at.high), low(l)) == side)
                at.low = l;
            else if (orientation(low(at.low), high(at.high), high(h)) == side)
                at.high = h;
            else
                break;
        }
        const auto back_on_low = [&](std::size_t i) {
            return is_bottom ? low_.next(i) : low_.previous(i);
        };
        const auto back_on_high = [&](std::size_t i) {
            return is_bottom ? high_.previous(i) : high_.next(i);
        };
        for (std::size_t l = back_on_low(at.low); is_between(low(l), at); l = back_on_low(l))
            at.low = l;
        for (std::size_t h = back_on_high(at.high); is_between(high(h), at); h = back_on_high(h))
            at.high = h;
        return at;
    }

    bool is_between(Point2 p, Tangent t) const {
        return orientation(low(t.low), high(t.high), p) == Collinear &&
               is_ahead(low(t.low), high(t.high), p) && is_ahead(high(t.high), low(t.low), p);
    }

    void link(std::uint32_t side, std::uint32_t twin) {
        triangles_[side >> 2].twins[side & 3U] = twin;
        triangles_[twin >> 2].twins[twin & 3U] = side;
    }

    /// The ghost's side that comes from the vertex that is none, and the one that goes to it.
    std::uint32_t from_ghost(std::uint32_t t) const {
        return 4 * t + Hull::ghost_corner(triangles_[t]);
    }
    std::uint32_t to_ghost(std::uint32_t t) const {
        return 4 * t + Side::previous_of(Hull::ghost_corner(triangles_[t]));
    }
    /// Of the triangle inside, the side of the hull's edge.
    std::uint32_t within(std::uint32_t t) const {
        return triangles_[t].twins[Side::next_of(Hull::ghost_corner(triangles_[t]))];
    }

    void fill(Tangent bottom, Tangent top) {
        // Edges of each hull that face the gap. Tangents that touch a hull in one vertex leave
        // that alone on the hull of both.
        std::size_t low_edges = (top.low + low_.size() - bottom.low) % low_.size();
        std::size_t high_edges = (bottom.high + high_.size() - top.high) % high_.size();
        const bool low_goes = low_edges == 0, high_goes = high_edges == 0;
        if (low_goes) low_edges = low_.size();
        if (high_goes) high_edges = high_.size();

        const auto below = static_cast<std::uint32_t>(triangles_.size() - 2), above = below + 1;
        // Neighbours of the new ghosts, while those of the gap are still ghosts.
        const std::uint32_t low_below =
            low_goes ? 4 * above + 2 : from_ghost(low_.ghost(low_.previous(bottom.low)));
        const std::uint32_t low_above = low_goes ? 4 * below + 1 : to_ghost(low_.ghost(top.low));
        const std::uint32_t high_below =
            high_goes ? 4 * above + 1 : to_ghost(high_.ghost(bottom.high));
        const std::uint32_t high_above =
            high_goes ? 4 * below + 2 : from_ghost(high_.ghost(high_.previous(top.high)));
        triangles_[below].vertices = {high_.vertex(bottom.high), low_.vertex(bottom.low), kGhost,
                                      0};
        triangles_[above].vertices = {low_.vertex(top.low), high_.vertex(top.high), kGhost, 0};
        std::uint32_t base = 4 * below;  // seen from below
        for (Tangent at = bottom; low_edges + high_edges > 0;) {
            const bool on_low = takes_low(at, low_edges > 0, high_edges > 0);
            const std::size_t edge = on_low ? at.low : high_.previous(at.high);
            const std::uint32_t t = on_low ? low_.ghost(edge) : high_.ghost(edge);
            const std::uint32_t inner = within(t);
            const std::uint32_t l = low_.vertex(at.low), h = high_.vertex(at.high);
            if (on_low) {
                at.low = low_.next(at.low);
                --low_edges;
            } else {
                at.high = edge;
                --high_edges;
            }
            triangles_[t].vertices = {l, h, on_low ? low_.vertex(at.low) : high_.vertex(at.high),
                                      0};
            link(4 * t, base);
            link(4 * t + (on_low ? 2 : 1), inner);
            base = 4 * t + (on_low ? 1 : 2);
            waiting_.push_back(4 * t);
            waiting_.push_back(inner);
        }
        link(4 * above, base);
        link(4 * below + 1, low_below);
        link(4 * below + 2, high_below);
        link(4 * above + 1, high_above);
        link(4 * above + 2, low_above);
    }

    /// Whether the triangle on the base takes the next vertex of the lower half's hull.
    bool takes_low(Tangent at, bool can_take_low, bool can_take_high) const {
        if (!can_take_low || !can_take_high) return can_take_low;
        const Point2 l = low(at.low), h = high(at.high);
        const Point2 next_low = low(low_.next(at.low));
        const Point2 next_high = high(high_.previous(at.high));
        if (orientation(l, h, next_low) != CounterClockwise) return false;
        return orientation(l, h, next_high) != CounterClockwise ||
               in_circle(l, h, next_low, next_high) != CircleSide::Inside;
    }

    bool swap_all() {
        while (!waiting_.empty()) {
            const std::uint32_t side = waiting_.back();
            waiting_.pop_back();
            if (!should_swap(side)) continue;
            if (left_-- == 0) return false;
            swap(side);
        }
        return true;
    }

    bool should_swap(std::uint32_t side) const {
        const Triangle& one = triangles_[side >> 2];
        const std::uint32_t twin = one.twins[side & 3U];
        const Triangle& other = triangles_[twin >> 2];
        if (one.is_ghost() || other.is_ghost()) return false;
        const auto& [a, b, c, unused] = one.vertices;
        return in_circle(points_[a], points_[b], points_[c],
                         points_[other.vertices[Side::previous_of(twin & 3U)]]) ==
               CircleSide::Inside;
    }

    //        c                c
    //       / .              /|.
    //      a - b     ->     a | b      one: (a, d, c), other: (d, b, c)
    //       . /              .|/
    //        d                d
    void swap(std::uint32_t side) {
        const std::uint32_t one = side >> 2, i = side & 3U;
        const Triangle was = triangles_[one];
        const std::uint32_t twin = was.twins[i], other = twin >> 2, j = twin & 3U;
        const Triangle too = triangles_[other];
        const std::uint32_t a = was.vertices[i], b = was.vertices[Side::next_of(i)],
                            c = was.vertices[Side::previous_of(i)],
                            d = too.vertices[Side::previous_of(j)];
        triangles_[one].vertices = {a, d, c, 0};
        triangles_[other].vertices = {d, b, c, 0};
        link(4 * one, too.twins[Side::next_of(j)]);
        link(4 * one + 2, was.twins[Side::previous_of(i)]);
        link(4 * other, too.twins[Side::previous_of(j)]);
        link(4 * other + 1, was.twins[Side::next_of(i)]);
        link(4 * one + 1, 4 * other + 2);
        for (const std::uint32_t outer : {4 * one, 4 * one + 2, 4 * other, 4 * other + 1})
            waiting_.push_back(outer);
    }

    std::span<const Point2> points_;
    std::span<Triangle> triangles_;
    PlanAxis axis_;
    Hull low_;
    Hull high_;
    std::size_t left_;                    ///< swaps that may still come
    std::vector<std::uint32_t> waiting_;  ///< sides whose edges may have to be swapped
};

}  // namespace

bool join(const DelaunayHalves& halves, std::size_t most_swaps) {
    return Seam(halves, most_swaps).close();
}

}  // namespace tinsmith::core
