// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/growing_delaunay.hpp"

#include <utility>

#include "core/predicates/in_circle.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ids.hpp"

namespace tinsmith::core {

namespace {

constexpr std::uint32_t next_side(std::uint32_t side) {
    return (side & ~3U) + Side::next_of(side & 3U);
}
constexpr std::uint32_t previous_side(std::uint32_t side) {
    return (side & ~3U) + Side::previous_of(side & 3U);
}

/// Whether p is to the right of a -> b. On lattices many points are on a line with an edge that is
/// upright or level: there the products are zero, and exact.
bool is_right(Point2 a, Point2 b, Point2 p) {
    const double left = (a.x - p.x) * (b.y - p.y);
    const double right = (a.y - p.y) * (b.x - p.x);
    if (left == 0.0 && right == 0.0) return false;
    return orientation(a, b, p) == Orientation::Clockwise;
}

}  // namespace

/// The first triangle a, b, c has the first slot; its ghosts the next: across a-b, b-c, c-a.
GrowingDelaunay::GrowingDelaunay(std::span<const Point2> points, Triangle* triangles, Share share)
    : points_(points),
      triangles_(triangles),
      end_(share.first_triangle + 4),
      last_(static_cast<std::uint32_t>(share.first_triangle)) {
    constexpr std::size_t kRoom = 128;  // more than nearly all insertions need
    stack_.reserve(kRoom);
    hole_.reserve(kRoom);
    rim_.reserve(kRoom);
    const auto a = static_cast<std::uint32_t>(share.first_point);
    const bool left = is_left(points[a], points[a + 1], points[a + 2]);
    const std::uint32_t b = a + (left ? 1 : 2), c = a + (left ? 2 : 1);
    const std::uint32_t t = last_;
    const auto side = [t](std::uint32_t triangle, unsigned i) { return 4 * (t + triangle) + i; };
    triangles_[t] = {{a, b, c, 0}, {side(1, 0), side(2, 0), side(3, 0), 0}};
    triangles_[t + 1] = {{b, a, kGhost, 0}, {side(0, 0), side(3, 2), side(2, 1), 0}};
    triangles_[t + 2] = {{c, b, kGhost, 0}, {side(0, 1), side(1, 2), side(3, 1), 0}};
    triangles_[t + 3] = {{a, c, kGhost, 0}, {side(0, 2), side(2, 2), side(1, 1), 0}};
}

void GrowingDelaunay::insert(std::uint32_t point) {
    const Point2 p = points_[point];
    dig(find(p), p);
    fill(point);
}

/// The triangle that p lies in or on the border of, or the ghost of an edge that p is outside of.
/// The walk ends: in a Delaunay triangulation the power of p falls from triangle to triangle.
std::uint32_t GrowingDelaunay::find(Point2 p) const {
    std::uint32_t t = last_;
    unsigned entered = 3;  // by no side
    while (true) {
        const Triangle& triangle = triangles_[t];
        std::uint32_t beyond = UINT32_MAX;
        if (entered == 3) {
            for (unsigned i = 0; i < 3 && beyond == UINT32_MAX; ++i)
                if (is_right(points_[triangle.vertices[i]],
                             points_[triangle.vertices[Side::next_of(i)]], p))
                    beyond = triangle.twins[i];
        } else {
            const unsigned first = Side::next_of(entered), second = Side::previous_of(entered);
            const Point2 apex = points_[triangle.vertices[second]];
            if (is_right(points_[triangle.vertices[first]], apex, p))
                beyond = triangle.twins[first];
            else if (is_right(apex, points_[triangle.vertices[entered]], p))
                beyond = triangle.twins[second];
        }
        if (beyond == UINT32_MAX) return t;
        t = beyond >> 2;
        entered = beyond & 3U;
        if (triangles_[t].is_ghost()) return t;
    }
}

/// Whether the triangle's circle holds p. That of a ghost is the open half-plane outside of its
/// edge, and the edge itself.
bool GrowingDelaunay::is_replaced_by(std::uint32_t triangle, Point2 p) const {
    const auto& [u, v, w, unused] = triangles_[triangle].vertices;
    if (!triangles_[triangle].is_ghost())
        return in_circle(points_[u], points_[v], points_[w], p) == CircleSide::Inside;
    const Point2 a = points_[u == kGhost ? v : v == kGhost ? w : u];
    const Point2 b = points_[u == kGhost ? w : v == kGhost ? u : v];
    const Orientation turn = orientation(a, b, p);
    if (turn != Orientation::Collinear) return turn == Orientation::CounterClockwise;
    return is_ahead(a, b, p) && is_ahead(b, a, p);
}

/// Finds the triangles that p replaces, and the rim around them to the left. They hang together
/// as a tree, for p sees all of them and no vertex is among them: so none is met twice.
///
///           c
///          / .
///      o' /   . o''     from within over a -> b to the outer side b -> a; where p replaces
///        /  o  .        that triangle too, a -> c and c -> b take the place of a -> b
///       a ----- b
///          hole
void GrowingDelaunay::dig(std::uint32_t triangle, Point2 p) {
    hole_.clear();
    rim_.clear();
    stack_.clear();
    hole_.push_back(triangle);
    for (unsigned i = 3; i-- > 0;)
        stack_.push_back(4 * triangle + i);
    while (!stack_.empty()) {
        const std::uint32_t inner = stack_.back();
        stack_.pop_back();
        const Triangle& within = triangles_[inner >> 2];
        const std::uint32_t outer = within.twins[inner & 3U];
        if (is_replaced_by(outer >> 2, p)) {
            hole_.push_back(outer >> 2);
            stack_.push_back(previous_side(outer));
            stack_.push_back(next_side(outer));
        } else {
            rim_.push_back({outer, within.vertices[inner & 3U]});
        }
    }
}

/// A triangle from each side of the rim to the point, in the slots of those that go and two more.
///
///        a ----- b       vertices: point, a, b
///         .     /        sides:    0 to a, 1 along the rim, 2 back to the point
///          . k /
///          point
void GrowingDelaunay::fill(std::uint32_t point) {
    hole_.push_back(static_cast<std::uint32_t>(end_));
    hole_.push_back(static_cast<std::uint32_t>(end_ + 1));
    end_ += 2;
    const std::size_t sides = rim_.size();
    std::uint32_t before = hole_[sides - 1];
    for (std::size_t k = 0; k < sides; ++k) {
        const bool is_end = k + 1 == sides;
        const std::uint32_t t = hole_[k];
        const std::uint32_t after = hole_[is_end ? 0 : k + 1];
        const Rim& rim = rim_[k];
        const std::uint32_t destination = rim_[is_end ? 0 : k + 1].origin;
        triangles_[t] = {{point, rim.origin, destination, 0},
                         {4 * before + 2, rim.outer, 4 * after, 0}};
        triangles_[rim.outer >> 2].twins[rim.outer & 3U] = 4 * t + 1;
        if (rim.origin != kGhost && destination != kGhost) last_ = t;
        before = t;
    }
}

}  // namespace tinsmith::core
