// SPDX-License-Identifier: Apache-2.0
// The march's plain landing: the segment ends inside the triangle in front, far from everything
// that rounding could confuse its end with. It does what `settle` and `reach` do there. Where
// segments are shorter than triangles almost all of them end so.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/integrate/march.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

/// Whether p is plainly left of the line, and farther from it than the distance.
[[gnu::always_inline]] inline bool is_well_left(Point2 a, Point2 b, Point2 p, double distance) {
    const AreaEstimate area = estimate_doubled_area(a, b, p);
    return area.value > distance * (std::fabs(b.x - a.x) + std::fabs(b.y - a.y)) + area.error;
}

}  // namespace

/// Whether the segment's end is plainly inside the triangle of `exit`.
//
//        left                 the way leaves the triangle by `exit`, right -> left, or the march
//       /     \               stands on its apex;
//   apex - end_ |             what is far from the three sides is far from all corners, and from
//       \     /               what lies across
//        right
bool March::lands_in(Side exit) const {
    const Point2 right = tin_.plan(tin_.origin(exit));
    const Point2 left = tin_.plan(tin_.destination(exit));
    const Point2 apex = tin_.plan(tin_.apex(exit));
    const double near = std::max(near_, reach_of_rounding_ * way_.edge_nearness);
    return is_well_left(right, left, end_, near) && is_well_left(left, apex, end_, near) &&
           is_well_left(apex, right, end_, near);
}

/// Whether to improve around what comes into a facet as soon as it is there.
bool March::improves_at_once() const {
    return improver_ != nullptr && put_off_ == 0;
}

/// Makes the segment's end a vertex. Requires: `lands_in`.
VertexId March::split_at_end(TriangleId t) {
    const std::uint32_t below = deepest_corner(t);
    const VertexId v = surgery_.split_triangle(t, {end_.x, end_.y, elevation_in(tin_, t, end_)});
    drift_.nest(v, below);
    return v;
}

/// Improves around the newest vertex, which split that triangle.
void March::improve_split(TriangleId t) {
    const auto count = static_cast<std::uint32_t>(tin_.triangle_count());
    const std::array outer{Side{t, 0}, Side{{count - 2}, 0}, Side{{count - 1}, 0}};
    constexpr std::uint64_t kMany = 24;
    constexpr std::size_t kPutOff = 63;
    if (improver_->improve_across(outer, knows_facets_) > kMany) put_off_ = kPutOff;
}

/// Goes to the segment's end, in the triangle in front; or stays where swaps that wait may change
/// what is in front: these are done then. Requires: `lands_in`, and the march stands on the apex.
void March::land(Side exit) {
    const bool at_once = improves_at_once();
    if (at_once && knows_facets_ && !changed_.empty()) {
        improver_->improve(changed_);
        changed_.clear();
        way_on_ = {};
        return;
    }
    const TriangleId t = exit.triangle();
    const unsigned corner = Side::previous_of(exit.index());  // where the march stands
    const VertexId v = split_at_end(t);
    // Of the split's new edges the one to that corner.
    const TriangleId beyond{static_cast<std::uint32_t>(tin_.triangle_count() - 2)};
    const Side edge = corner == 2 ? Side{beyond, 1} : Side{t, corner == 0 ? 2U : 1U};
    surgery_.mark_constrained(edge);
    if (options_.lock) surgery_.set_locked(edge, true);
    if (!at_once || !knows_facets_) flush_open();
    open_ = {};
    at_ = v;
    tally_.chains.back().vertices.push_back(v);
    if (at_once) {
        improve_split(t);
        return;
    }
    if (put_off_ > 0) --put_off_;
    changed_.push_back(v);
}

/// Makes the segment's end a vertex where edges inside the facet are in the way, and improves
/// around it before it is joined to where the march stands: mostly that joins them.
VertexId March::land_beyond(Side exit) {
    const TriangleId t = exit.triangle();
    const VertexId v = split_at_end(t);
    improve_split(t);
    return v;
}

}  // namespace tinsmith::core
