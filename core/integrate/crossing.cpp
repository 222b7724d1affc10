// SPDX-License-Identifier: Apache-2.0
// Where the march meets an edge that it may not swap away: finding the point that splits it.
#include <algorithm>
#include <cmath>

#include "core/integrate/march.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

using enum Orientation;

namespace {

bool is_before(Point2 p, Point2 q) { return p.x != q.x ? p.x < q.x : p.y < q.y; }

double distance_to_segment(Point2 p, Point2 a, Point2 b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double ahead = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double squared = dx * dx + dy * dy;
    if (ahead <= 0.0) return std::sqrt((p.x - a.x) * (p.x - a.x) + (p.y - a.y) * (p.y - a.y));
    if (ahead >= squared) return std::sqrt((p.x - b.x) * (p.x - b.x) + (p.y - b.y) * (p.y - b.y));
    return std::fabs(compensated_doubled_area(a, b, p)) / std::sqrt(squared);
}

}  // namespace

/// `exit` is a -> b with a on the right of the way and b on the left, both strictly, and the end
/// beyond it. Splits it where the input segment crosses. What can go wrong is rounding only, and
/// then, in this order: a neighbouring double; the place where the march stands goes onto the
/// edge; the end goes onto it; the way goes through the end of the edge that it touches.
bool March::cross_facet_edge(Side exit, bool needs_swaps) {
    const VertexId a = tin_.origin(exit);
    const VertexId b = tin_.destination(exit);
    // Earlier vertices of the chain are off the input segment by rounding, so the way from here
    // can pass an edge's end on the other side than the input does: then it goes through that.
    const bool a_met = orientation(start_, end_, tin_.plan(a)) != Clockwise;
    const bool b_met = orientation(start_, end_, tin_.plan(b)) != CounterClockwise;
    if (a_met && is_within_rounding(tin_.plan(a))) return connect(a);
    if (b_met && is_within_rounding(tin_.plan(b))) return connect(b);

    if (const std::optional<Point2> p = find_split(exit); p && !a_met && !b_met) {
        count_crossing(exit);
        return reach(place({Location::Kind::OnEdge, exit, {}}, *p), needs_swaps);
    }
    if (!needs_swaps && can_absorb(exit)) {
        surgery_.absorb_apex(exit);
        ++tally_.edges_swapped;
        changed_.push_back(at_);
        return true;
    }
    if (!tin_.twin(exit).valid() && !needs_swaps &&
        distance_to_segment(tin_.plan(at_), tin_.plan(a), tin_.plan(b)) <= reach_of_rounding_) {
        leave_mesh();
        boundary_visits_.insert(boundary_visits_.end(), {a, b});
        return true;
    }
    if (distance_to_segment(end_, tin_.plan(a), tin_.plan(b)) <= reach_of_rounding_ &&
        can_split(exit, end_))
        return reach(place({Location::Kind::OnEdge, exit, {}}, end_), needs_swaps);
    for (const VertexId v : {a, b})
        if (is_within_rounding(tin_.plan(v))) return connect(v);
    return fail(ErrorCode::NotRepresentable,
                "no mesh of doubles holds this segment within rounding; move it, or give a snap "
                "distance");
}

/// The input segment's point on the edge, or a neighbour of it, that leaves all triangles strictly
/// positive.
std::optional<Point2> March::find_split(Side edge) const {
    const Point2 p = intersection(edge);
    if (can_split(edge, p)) return p;
    std::optional<Point2> best;
    double best_distance = reach_of_rounding_;
    for (const double x : {p.x, neighbour(p.x, false), neighbour(p.x, true)}) {
        for (const double y : {p.y, neighbour(p.y, false), neighbour(p.y, true)}) {
            const Point2 q{x, y};
            const double distance = distance_to_segment(q, start_, end_);
            if (distance < best_distance && can_split(edge, q)) {
                best = q;
                best_distance = distance;
            }
        }
    }
    return best;
}

/// Where the line through the input segment crosses the edge, rounded once: off by an ulp or so in
/// each coordinate. The same bits for the reversed segment and from the edge's other side.
Point2 March::intersection(Side edge) const {
    Point2 a = tin_.plan(tin_.origin(edge));
    Point2 b = tin_.plan(tin_.destination(edge));
    const Point2 low = is_before(start_, end_) ? start_ : end_;
    const Point2 high = is_before(start_, end_) ? end_ : start_;
    const AreaEstimate estimate_a = estimate_doubled_area(low, high, a);
    const AreaEstimate estimate_b = estimate_doubled_area(low, high, b);
    double to_a = std::fabs(estimate_a.value);
    double to_b = std::fabs(estimate_b.value);
    const double length = std::max(std::fabs(b.x - a.x), std::fabs(b.y - a.y));
    // The estimates' error moves the point along the edge; more than a sixteenth of what rounding
    // may do is too much.
    const double error = (estimate_a.error + estimate_b.error) * length;
    if (!(error <= reach_of_rounding_ / 16.0 * (to_a + to_b))) {
        to_a = std::fabs(detail::accurate_doubled_area(low, high, a));
        to_b = std::fabs(detail::accurate_doubled_area(low, high, b));
    }
    // From the nearer end, so that the point's error shrinks with its distance to it.
    if (to_b < to_a || (to_a == to_b && is_before(b, a))) {
        std::swap(a, b);
        std::swap(to_a, to_b);
    }
    const double share = to_a / (to_a + to_b);
    const Point2 p{a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
    return {std::clamp(p.x, std::min(a.x, b.x), std::max(a.x, b.x)),
            std::clamp(p.y, std::min(a.y, b.y), std::max(a.y, b.y))};
}

/// Whether all triangles are strictly positive after a split of the edge at p.
bool March::can_split(Side edge, Point2 p) const {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    const Point2 c = tin_.plan(tin_.apex(edge));
    if (!is_left(a, p, c) || !is_left(p, b, c)) return false;
    const Side across = tin_.twin(edge);
    if (!across.valid()) return true;
    const Point2 d = tin_.plan(tin_.apex(across));
    return is_left(b, p, d) && is_left(p, a, d);
}

/// Whether the vertex on which the march stands, the apex of the edge's triangle, lies on the edge
/// to within rounding and can be taken onto it.
bool March::can_absorb(Side edge) const {
    const Side across = tin_.twin(edge);
    if (!across.valid() || tin_.apex(edge) != at_) return false;
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    const Point2 c = tin_.plan(at_);
    const Point2 d = tin_.plan(tin_.apex(across));
    return distance_to_segment(c, a, b) <= reach_of_rounding_ && is_left(a, d, c) &&
           is_left(d, b, c);
}

bool March::is_within_rounding(Point2 p) const {
    return distance_to_segment(p, start_, end_) <= reach_of_rounding_;
}

void March::count_crossing(Side edge) {
    if (surgery_.is_fresh(edge) && !tin_.separates_facets(edge))
        ++tally_.self_crossings;
    else
        ++tally_.crossings;
}

void March::measure(Point2 p) {
    if (p == start_ || p == end_) return;
    tally_.max_plan_deviation =
        std::max(tally_.max_plan_deviation, distance_to_segment(p, start_, end_));
}

}  // namespace tinsmith::core
