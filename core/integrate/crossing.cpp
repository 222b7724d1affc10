// SPDX-License-Identifier: Apache-2.0
// Where the march meets an edge that it may not swap away: finding the point that splits it.
#include <algorithm>
#include <cmath>

#include "core/integrate/distance.hpp"
#include "core/integrate/march.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

using enum Orientation;

namespace {

bool is_before(Point2 p, Point2 q) {
    return p.x != q.x ? p.x < q.x : p.y < q.y;
}

}  // namespace

/// `exit` is a -> b with a on the right of the way and b on the left, both strictly, and the end
/// beyond it. What is one to within rounding becomes one: an end of the edge on the input segment
/// is the crossing (so a segment that is integrated again meets the vertices of its own chain); the
/// vertex where the march stands, or the segment's end, is when it is on the edge. Otherwise the
/// edge is split where the input segment crosses it, or at a neighbouring double.
bool March::cross_facet_edge(Side exit, bool needs_swaps) {
    const double rounding = reach_of_rounding_ * way_.edge_nearness;
    // Beyond edges to be swapped, rounding may have bent the outline into the straight way there.
    const std::optional<VertexId> met = end_within(exit, near_);
    if (met && (!needs_swaps || has_way(*met))) return connect(*met);
    if (tin_.apex(exit) == at_ && can_absorb(exit, rounding)) return absorb(exit);
    if (is_near_edge(exit, end_, reach_of_rounding_)) {
        if (is_near_edge(exit, end_, rounding) && can_bend(exit, end_) && can_split(exit, end_))
            return reach(place({Location::Kind::OnEdge, exit, {}}, end_), needs_swaps);
        is_delicate_ = true;
    }
    // Only where the chain comes from the outline: a region's border must reach it.
    if (!tin_.twin(exit).valid() && !needs_swaps && comes_from_end_of(exit) &&
        is_near_edge(exit, tin_.plan(at_), rounding))
        return leave_across(exit);
    if (way_.goes_beside)
        if (const std::optional<VertexId> end = end_beside(exit)) return connect(*end);
    if (const std::optional<Point2> p = find_split(exit)) {
        count_crossing(exit);
        const VertexId v = place_on(exit, *p);
        way_on_ = tin_.twin(exit);  // on the far side, where the way goes on
        if (needs_swaps || tin_.apex(exit) != at_) return connect(v);
        step_along(exit.next(), v);
        return true;
    }
    is_delicate_ = true;
    // Only rounding can forbid the split: a triangle beside the edge is a needle. There is room
    // beyond it; or its middle vertex goes onto its long side; or whatever else is within reach.
    if (split_beyond(tin_.twin(exit))) return true;
    if (absorb_needle_at(exit)) return true;
    if (!tin_.twin(exit).valid() && !needs_swaps &&
        is_near_edge(exit, tin_.plan(at_), reach_of_rounding_))
        return leave_across(exit);
    if (is_near_edge(exit, end_, reach_of_rounding_) && can_split(exit, end_))
        return reach(place({Location::Kind::OnEdge, exit, {}}, end_), needs_swaps);
    if (const std::optional<VertexId> end = end_within(exit, reach_of_rounding_))
        return connect(*end);
    if (const std::optional<VertexId> end = end_beside(exit)) return connect(*end);
    return fail(ErrorCode::NotRepresentable,
                "no mesh of doubles holds this segment within rounding; move it a little");
}

/// Whether the chain's vertex before this one is an end of the edge.
bool March::comes_from_end_of(Side edge) const {
    const std::vector<VertexId>& chain = tally_.chains.back().vertices;
    if (chain.size() < 2) return false;
    const VertexId last = chain[chain.size() - 2];
    return last == tin_.origin(edge) || last == tin_.destination(edge);
}

/// Leaves the mesh through a boundary edge that the march stands on to within rounding.
bool March::leave_across(Side edge) {
    is_delicate_ = true;
    const VertexId a = tin_.origin(edge), b = tin_.destination(edge);
    leave_mesh();
    boundary_visits_.insert(a);
    boundary_visits_.insert(b);
    return true;
}

/// The input segment's point on the edge, or a neighbour of it, that leaves all triangles strictly
/// positive.
std::optional<Point2> March::find_split(Side edge) {
    const Point2 p = intersection(edge);
    if (can_split(edge, p)) return p;
    is_delicate_ = true;
    std::optional<Point2> best;
    // Where a snap put the march beside the segment the way to its end is as far from it.
    double best_distance = std::max(options_.snap, reach_of_rounding_);
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
    return best || !way_.splits_along ? best : find_split_along(edge, p);
}

/// Where triangles beside the edge are too narrow at p for any double: the next place along the
/// edge, away from p's nearer end, that is still within rounding of the input segment. There is one
/// where the two run almost side by side.
std::optional<Point2> March::find_split_along(Side edge, Point2 p) const {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    const bool a_is_nearer =
        std::fabs(p.x - a.x) + std::fabs(p.y - a.y) < std::fabs(p.x - b.x) + std::fabs(p.y - b.y);
    const Point2 far = a_is_nearer ? b : a;
    const double length = std::sqrt((far.x - p.x) * (far.x - p.x) + (far.y - p.y) * (far.y - p.y));
    // NOLINTNEXTLINE(cert-flp30-c): it grows by a factor, nothing is counted
    for (double step = reach_of_rounding_; step < length; step *= 2.0) {
        const Point2 q{p.x + (far.x - p.x) * (step / length),
                       p.y + (far.y - p.y) * (step / length)};
        if (distance_to_segment(q, start_, end_) > std::max(options_.snap, reach_of_rounding_))
            return {};
        if (at_.valid() && !is_ahead_of(tin_.plan(at_), q)) return {};
        if (can_split(edge, q)) return q;
    }
    return {};
}

/// Where the input segment crosses the edge. A vertex that rounding or a snap put beside the
/// segment may stand before an edge that the segment misses or crosses farther back: from there,
/// where the straight way to its end does, which is no farther from the segment than the vertex is.
Point2 March::intersection(Side edge) {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    if (!at_.valid() || tin_.plan(at_) == start_) {
        if (is_near_edge(edge, start_, reach_of_rounding_)) is_delicate_ = true;
        return crossing_of(start_, end_, a, b);
    }
    const Point2 here = tin_.plan(at_);
    const bool misses =
        options_.snap > 0.0 && orientation(start_, end_, a) == orientation(start_, end_, b);
    const Point2 p = misses ? here : crossing_of(start_, end_, a, b);
    const double at = along(p);
    const bool is_on_way = !misses && at > along(here) && at <= along(end_);
    if (is_on_way) return p;
    is_delicate_ = true;
    return crossing_of(here, end_, a, b);
}

/// Where two segments that cross do, rounded once: off by an ulp or so in each coordinate. The same
/// bits in whichever direction either is given.
Point2 March::crossing_of(Point2 low, Point2 high, Point2 a, Point2 b) {
    if (is_before(high, low)) std::swap(low, high);
    const AreaEstimate estimate_a = estimate_doubled_area(low, high, a);
    const AreaEstimate estimate_b = estimate_doubled_area(low, high, b);
    // The input segment need not cross what the way crosses.
    is_delicate_ = is_delicate_ || estimate_a.value * estimate_b.value >= 0.0;
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
    if (!across.valid()) return is_clear_of_boundary(edge, p);
    const Point2 d = tin_.plan(tin_.apex(across));
    return is_left(b, p, d) && is_left(p, a, d);
}

/// Whether a boundary edge bent out to p runs into neither of the boundary edges beside it: where
/// rounding bent those too, they can be that near.
bool March::is_clear_of_boundary(Side edge, Point2 p) const {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    if (orientation(a, b, p) != Clockwise) return true;
    Side after = edge.next();  // around b, and around a, ends at the fan's other side
    while (tin_.twin(after).valid())
        after = tin_.twin(after).next();
    const Point2 n = tin_.plan(tin_.destination(after));
    if (orientation(a, b, n) != CounterClockwise && orientation(b, n, p) != Clockwise) return false;
    Side before = edge.previous();
    while (tin_.twin(before).valid())
        before = tin_.twin(before).previous();
    const Point2 m = tin_.plan(tin_.origin(before));
    return orientation(m, a, b) == CounterClockwise || orientation(m, a, p) == Clockwise;
}

/// Whether p is within the distance of the edge. Filtered: costs a plain determinant where it is
/// not.
bool March::is_near_edge(Side edge, Point2 p, double distance) const {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    const AreaEstimate area = estimate_doubled_area(a, b, p);
    const double length_bound = std::fabs(b.x - a.x) + std::fabs(b.y - a.y);
    if (std::fabs(area.value) > distance * length_bound + area.error) return false;
    return distance_to_segment(p, a, b) <= distance;
}

/// Whether the apex of the edge's triangle is within the distance of the edge and can be taken onto
/// it: the triangle is a needle that rounding made. Where all is needles one can lead to the next
/// and back, so a vertex takes a few only.
bool March::can_absorb(Side edge, double distance) const {
    const Side across = tin_.twin(edge);
    if (!across.valid()) return false;
    if (absorbed_at_ == at_ && absorbed_ >= kMaxAbsorbed) return false;
    const Point2 c = tin_.plan(tin_.apex(edge));
    if (!is_near_edge(edge, c, distance) || !can_bend(edge, c)) return false;
    const Point2 d = tin_.plan(tin_.apex(across));
    if (!way_.absorbs_cliffs && is_cliff(edge)) return false;
    return is_left(tin_.plan(tin_.origin(edge)), d, c) &&
           is_left(d, tin_.plan(tin_.destination(edge)), c);
}

/// Whether the needle beside the edge, whose apex is all but on it, is a step of the surface that
/// the facet across would have to take in. One that is a needle itself is that narrow all over.
bool March::is_cliff(Side edge) const {
    const VertexId apex = tin_.apex(edge);
    if (std::fabs(tin_.vertex(apex).z - elevation_on(tin_, edge, tin_.plan(apex))) <= flat_)
        return false;
    const Side across = tin_.twin(edge);
    return !is_near_edge(edge, tin_.plan(tin_.apex(across)), reach_of_rounding_) ||
           !tin_.separates_facets(across.next()) || !tin_.separates_facets(across.previous());
}

/// What takes a cliff in is not flat: each of its triangles is a facet then.
bool March::absorb(Side edge) {
    const Side across = tin_.twin(edge);
    const bool bends = is_cliff(edge);
    is_delicate_ = true;
    absorbed_ = absorbed_at_ == at_ ? absorbed_ + 1 : 1;
    absorbed_at_ = at_;
    const VertexId apex = tin_.apex(edge);
    if (tin_.separates_facets(edge)) drift_.bend(apex, bend_of(edge, tin_.plan(apex)));
    changed_.push_back(apex);
    surgery_.absorb_apex(edge);
    if (bends)
        for (const Side side : {edge, across})
            surgery_.give_fresh_facet(side.triangle());
    ++tally_.edges_swapped;
    return true;
}

/// Absorbs a needle beside the edge, if there is one.
bool March::absorb_needle_at(Side edge) {
    for (const Side beside : {edge, tin_.twin(edge)}) {
        if (!beside.valid()) continue;
        for (const Side side : {beside, beside.next(), beside.previous()})
            if (can_absorb(side, reach_of_rounding_)) return absorb(side);
    }
    return false;
}

/// Where the triangle on the way, which the side belongs to, is a needle without a double inside:
/// splits the edge through which the way leaves it, at a position that may be beyond it by
/// rounding. That makes room for the split of the edge through which the way comes.
//
//      left -------- right      the way comes from above, through `entry`, left -> right; one of
//          \  needle /          its ends is all but on the other edge that the way crosses
//             apex
bool March::split_beyond(Side entry) {
    const Point2 from = at_.valid() ? tin_.plan(at_) : start_;
    for (unsigned needles = 0; needles < kMaxNeedles && entry.valid(); ++needles) {
        const Orientation turn = orientation(from, end_, tin_.plan(tin_.apex(entry)));
        if (turn == Collinear || beyond_ == kMaxAbsorbed) return false;
        const Side far = turn == CounterClockwise ? entry.next() : entry.previous();
        if (!tin_.is_fixed(far) && !tin_.separates_facets(far)) return false;
        if (!is_near_edge(far, tin_.plan(tin_.apex(far)), reach_of_rounding_)) return false;
        if (const std::optional<Point2> p = find_split(far)) {
            ++beyond_;
            is_delicate_ = true;
            count_crossing(far);
            place_on(far, *p);
            return true;
        }
        entry = tin_.twin(far);
    }
    return false;
}

/// The end of the edge that is nearest to the input segment, where it is within the distance.
/// Filtered: costs two plain determinants where neither is.
std::optional<VertexId> March::end_within(Side edge, double distance) const {
    std::optional<VertexId> nearest;
    for (const VertexId v : {tin_.origin(edge), tin_.destination(edge)}) {
        const Point2 p = tin_.plan(v);
        if (!is_near_segment(p, distance)) continue;
        // Never back: what is not ahead of where the march stands was passed.
        if (at_.valid() && !is_ahead_of(tin_.plan(at_), p)) continue;
        distance = distance_to_segment(p, start_, end_);
        nearest = v;
    }
    return nearest;
}

/// Whether q is farther along the input segment than p. Right where the two are so near each other
/// that `along` is the same for both: their difference is exact there.
bool March::is_ahead_of(Point2 p, Point2 q) const {
    return (q.x - p.x) * (end_.x - start_.x) + (q.y - p.y) * (end_.y - start_.y) > 0.0;
}

/// Whether the way goes through the vertex, though it is inside a facet.
bool March::is_ahead_within_snap(VertexId v) const {
    const Point2 p = tin_.plan(v);
    return is_near_segment(p, way_.meets_all ? near_ : snap_) && is_ahead_of(tin_.plan(at_), p);
}

/// An end of the edge that is one with the vertex where the march stands, to within rounding, and
/// that this segment did not step to for that before.
std::optional<VertexId> March::end_beside(Side edge) {
    const Point2 here = tin_.plan(at_);
    for (const VertexId v : {tin_.origin(edge), tin_.destination(edge)}) {
        const Point2 p = tin_.plan(v);
        if (v == at_ || detours_.contains(v)) continue;
        if (!is_near_segment(p, reach_of_rounding_)) continue;
        if (std::max(std::fabs(p.x - here.x), std::fabs(p.y - here.y)) > reach_of_rounding_)
            continue;
        detours_.insert(v);
        is_delicate_ = true;
        return v;
    }
    return {};
}

/// Whether p is within the distance of the input segment. Filtered like `is_near_edge`.
bool March::is_near_segment(Point2 p, double distance) const {
    const AreaEstimate area = estimate_doubled_area(start_, end_, p);
    if (std::fabs(area.value) > distance * length_ + area.error) return false;
    return distance_to_segment(p, start_, end_) <= distance;
}

void March::count_crossing(Side edge) {
    if (surgery_.is_fresh(edge) && !tin_.separates_facets(edge))
        ++tally_.self_crossings;
    else
        ++tally_.crossings;
}

/// Measures how far the vertex is from the input segment. Filtered: most are nearer than any that
/// needs to be known.
void March::measure(VertexId v) {
    const Point2 p = tin_.plan(v);
    const AreaEstimate area = estimate_doubled_area(start_, end_, p);
    const double known = std::min(tally_.max_plan_deviation, drift_.usual());
    if (std::fabs(area.value) + area.error <= known * length_ && is_beside_segment(p)) return;
    if (p == start_ || p == end_) return;
    const double distance = distance_to_segment(p, start_, end_);
    tally_.max_plan_deviation = std::max(tally_.max_plan_deviation, distance);
    if (distance > drift_.usual()) drift_.stray(v, distance);
}

/// Whether p is between the ends of the input segment, along it.
bool March::is_beside_segment(Point2 p) const {
    const double at = along(p);
    return at >= 0.0 && at <= length_ * length_;
}

}  // namespace tinsmith::core
