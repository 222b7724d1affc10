// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/march.hpp"

#include <algorithm>
#include <cmath>

#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

using enum Orientation;

March::March(Surgery& surgery, const MarchLimits& limits)
    : surgery_(surgery), tin_(surgery.tin()), limits_(limits) {
    const Bounds& box = tin_.bounds();
    const double largest = std::max(
        {std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.max.x), std::fabs(box.max.y)});
    reach_of_rounding_ = 4.0 * ulp(largest);
}

bool March::begin(std::size_t path, Point2 start) {
    path_ = path;
    end_ = start;
    outside_.clear();
    Location location = locate(tin_, start, tin_.hint(start));
    if (location.kind == Location::Kind::Outside) location = locate_on_boundary(start);
    if (location.kind == Location::Kind::Outside) {
        at_ = {};
        outside_.push_back(start);
        return within_limits();
    }
    tally_.met_mesh = true;
    at_ = place(location, start);
    return within_limits();
}

bool March::advance(Point2 end) {
    start_ = end_;
    end_ = end;
    length_ = std::sqrt((end.x - start_.x) * (end.x - start_.x) +
                        (end.y - start_.y) * (end.y - start_.y));
    steps_ = 0;
    boundary_visits_.clear();
    entries_known_ = false;
    spent_edges_.clear();
    ++tally_.segments;
    if (!within_budget()) return false;
    while (true) {
        if (!at_.valid() && !enter()) return !error_;
        if (tin_.plan(at_) == end_) return true;
        if (!within_budget()) return false;
        const Departure departure = leave(tin_, at_, end_, side_from(tin_, at_));
        switch (departure.kind) {
            case Departure::Kind::AlongEdge:
                if (!follow(departure)) return false;
                break;
            case Departure::Kind::ThroughEdge:
                if (!cross(departure.side)) return false;
                break;
            case Departure::Kind::Outside:
                if (const Side edge = edge_on_way(along(end_)); edge.valid())
                    follow_edge(edge);
                else
                    leave_mesh();
                break;
        }
    }
}

bool March::finish() {
    if (!at_.valid()) close_outside();
    at_ = {};
    return within_limits();
}

/// Makes a position that was located a vertex, on the facet's plane or edge. One that is on an edge
/// to within rounding goes onto the edge: no needle is left between them.
VertexId March::place(Location location, Point2 p) {
    VertexId v = location.vertex;
    if (location.kind == Location::Kind::InTriangle) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(location.side.triangle(), i);
            if (is_near_edge(side, p, reach_of_rounding_ / 2.0) && can_split(side, p))
                location = {Location::Kind::OnEdge, side, {}};
        }
    }
    switch (location.kind) {
        case Location::Kind::InTriangle: {
            const TriangleId t = location.side.triangle();
            v = surgery_.split_triangle(t, {p.x, p.y, elevation_in(tin_, t, p)});
            break;
        }
        case Location::Kind::OnEdge:
            v = surgery_.split_edge(location.side,
                                    {p.x, p.y, elevation_on(tin_, location.side, p)});
            break;
        case Location::Kind::OnVertex:
        case Location::Kind::Outside:
            return v;
    }
    changed_.push_back(v);
    return v;
}

/// Goes along an edge to its far end, or to the segment's end where that comes first.
bool March::follow(const Departure& departure) {
    const VertexId next = departure.along(tin_, at_);
    if (tin_.plan(next) != end_ && is_ahead(tin_.plan(next), tin_.plan(at_), end_)) {
        // The end lies on the line through both ends and before the far one: on the edge.
        const VertexId end = place({Location::Kind::OnEdge, departure.side, {}}, end_);
        return reach(end, false);
    }
    follow_edge(departure.side);
    return true;
}

/// Goes along an edge from where the march stands to its other end.
void March::follow_edge(Side edge) {
    surgery_.mark_constrained(edge);
    at_ = tin_.origin(edge) == at_ ? tin_.destination(edge) : tin_.origin(edge);
    measure(tin_.plan(at_));
}

/// Goes through triangles, from the one in front of `at_` whose far side is `exit`, up to the first
/// edge between facets, vertex on the way, or the segment's end.
//
//        left                 the way at_ -> end_ passes left of `right` and right of `left`;
//       / | \                 `exit` is right -> left, entry its twin left -> right
//   at_   |  apex  -> end_
//       \ | /
//        right
bool March::cross(Side exit) {
    bool needs_swaps = false;
    while (true) {
        const Point2 right = tin_.plan(tin_.origin(exit));
        const Point2 left = tin_.plan(tin_.destination(exit));
        switch (orientation(right, left, end_)) {
            case CounterClockwise:
                return reach(place({Location::Kind::InTriangle, exit, {}}, end_), needs_swaps);
            case Collinear:
                return reach(place({Location::Kind::OnEdge, exit, {}}, end_), needs_swaps);
            case Clockwise:
                break;
        }
        if (tin_.is_fixed(exit) || tin_.separates_facets(exit))
            return cross_facet_edge(exit, needs_swaps);
        if (!within_budget()) return false;
        needs_swaps = true;
        const Side entry = tin_.twin(exit);
        const VertexId apex = tin_.apex(entry);
        switch (orientation(tin_.plan(at_), end_, tin_.plan(apex))) {
            case Collinear:
                if (tin_.plan(apex) != end_ && is_ahead(tin_.plan(apex), tin_.plan(at_), end_))
                    return reach(place({Location::Kind::InTriangle, entry, {}}, end_), true);
                return reach(apex, true);
            case CounterClockwise:
                exit = entry.next();
                break;
            case Clockwise:
                exit = entry.previous();
                break;
        }
    }
}

/// Stands on t next, with the edge to it constrained; swaps first where edges are in the way.
bool March::reach(VertexId t, bool needs_swaps) {
    if (needs_swaps) return connect(t);
    surgery_.mark_constrained(find_edge(tin_, t, at_));
    measure(tin_.plan(t));
    at_ = t;
    return true;
}

bool March::within_budget() {
    // A straight way meets each triangle once; the rest is room for what rounding repeats.
    if (++steps_ > 4 * tin_.triangle_count() + 1024)
        return fail(ErrorCode::StepBudget,
                    "a defect of the program, not of the request: the march did not end within its "
                    "budget of steps; nothing was changed; report it with the request");
    return within_limits();
}

bool March::within_limits() {
    if (tally_.crossings + tally_.self_crossings > limits_.max_crossings)
        return fail(ErrorCode::CrossingBudget,
                    "the request crosses more edges than allowed; send it in parts");
    if (tin_.triangle_count() - surgery_.record().triangle_count > limits_.max_new_triangles)
        return fail(ErrorCode::TriangleBudget,
                    "the request makes more triangles than allowed; send it in parts");
    constexpr std::uint64_t kAskEvery = 256;
    if (limits_.cancelled != nullptr && *limits_.cancelled && asked_++ % kAskEvery == 0 &&
        (*limits_.cancelled)())
        return fail(ErrorCode::Cancelled, "the request was cancelled; nothing was changed");
    return true;
}

bool March::fail(ErrorCode code, const char* detail) {
    ErrorPlace place;
    place.path = path_;
    place.position = at_.valid() ? tin_.plan(at_) : start_;
    error_ = Error{code, detail, place};
    return false;
}

}  // namespace tinsmith::core
