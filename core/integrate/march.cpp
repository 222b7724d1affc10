// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/march.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/integrate/distance.hpp"
#include "core/integrate/reach.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

using enum Orientation;

namespace {

bool is_within(Point2 p, Point2 q, double distance) {
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) <= distance * distance;
}

}  // namespace

March::March(Surgery& surgery, const IntegrateOptions& options, const MarchLimits& limits,
             Drift& drift, Improver* improver)
    : surgery_(surgery),
      tin_(surgery.tin()),
      options_(options),
      limits_(limits),
      drift_(drift),
      improver_(improver),
      knows_facets_(improver != nullptr && drift.first() == tin_.built_vertex_count()) {
    reach_of_rounding_ = reach_of_rounding(tin_);
    const Bounds& box = tin_.bounds();
    flat_ = 1e-10 * distance_between(box.min.plan(), box.max.plan());
    set_snap(options.snap);
}

void March::set_snap(double snap) {
    snap_ = snap;
    near_ = std::max(snap, reach_of_rounding_ * way_.nearness);
}

bool March::begin(std::size_t index, const Path& path, const Way& way) {
    path_ = &path;
    way_ = way;
    // Elevations make no two vertices of what may be one.
    if (!path.elevations.empty()) way_.meets_all = true;
    set_snap(options_.snap);
    may_land_ = options_.snap == 0.0 && !way_.meets_all && !way_.settles_first;
    path_index_ = index;
    exit_ahead_ = {};
    from_ = to_ = 0;
    steps_ = 0;
    const Point2 start = path.points.front();
    start_ = end_ = start;
    at_ = {};
    if (!has_ids()) return false;
    outside_.clear();
    first_ = {};
    if (way_.settles_first) settle_all();
    const std::size_t triangles = tin_.triangle_count();
    const TriangleId seed =
        options_.walk_seed == 0
            ? tin_.hint(start)
            : TriangleId{static_cast<std::uint32_t>(options_.walk_seed % triangles)};
    Location location = locate(tin_, start, seed);
    if (location.kind == Location::Kind::Outside) location = locate_on_boundary(start);
    if (location.kind == Location::Kind::Outside) {
        at_ = {};
        outside_.push_back(start);
        return look_at_limits();
    }
    tally_.met_mesh = true;
    tally_.chains.push_back({path_index_, {}});
    stand_on(settle(location, start));
    first_ = at_;
    return look_at_limits();
}

/// Makes all points of the path that are on the mesh vertices before any segment is there.
void March::settle_all() {
    for (const Point2 p : path_->points) {
        const Location location = locate(tin_, p, tin_.hint(p));
        if (location.kind != Location::Kind::Outside) settle(location, p);
    }
}

bool March::advance(std::size_t to) {
    from_ = to_;
    to_ = to;
    ++tally_.segments;
    set_segment(end_, path_->points[to]);
    if (ahead_ != end_) exit_ahead_ = {};
    ahead_ = path_->points[to + 1 < path_->points.size() ? to + 1 : 0];
    fetch_path();
    bool done = march_to_end();
    // Where snapping led into a dead end, the rest of the segment goes straight.
    if (!done && snap_ > 0.0 && error_ &&
        (error_->code == ErrorCode::NotRepresentable || error_->code == ErrorCode::StepBudget)) {
        error_.reset();
        is_delicate_ = true;
        set_snap(0.0);
        steps_ = 0;
        done = march_to_end();
    }
    set_snap(options_.snap);
    return done;
}

/// A ring that snapped ends where it began, on the mesh or outside, not at another vertex within
/// snap of that.
bool March::march_home() {
    const Point2 home = first_.valid() ? tin_.plan(first_) : path_->points.front();
    if (tin_.plan(at_) == home) return true;
    set_snap(0.0);
    exit_ahead_ = {};
    const bool takes_corners = std::exchange(way_.takes_corners, false);
    set_segment(tin_.plan(at_), home);
    from_ = to_;
    const bool done = march_to_end();
    way_.takes_corners = takes_corners;
    set_snap(options_.snap);
    return done;
}

void March::set_segment(Point2 start, Point2 end) {
    start_ = start;
    end_ = end;
    length_ =
        std::sqrt((end.x - start.x) * (end.x - start.x) + (end.y - start.y) * (end.y - start.y));
    steps_ = 0;
    boundary_visits_.clear();
    entries_known_ = false;
    spent_edges_.clear();
    detours_.clear();
    beyond_ = 0;
}

bool March::march_to_end() {
    if (!within_budget()) return false;
    // For the first step of this segment and no other: it may be no step long.
    Side known = std::exchange(exit_ahead_, {});
    while (true) {
        if (!at_.valid() && !enter()) return !error_ && is_as_promised();
        if (has_arrived()) {
            log_elevation(1.0);
            return is_as_promised();
        }
        if (!within_budget()) return false;
        Departure departure{Departure::Kind::ThroughEdge, std::exchange(known, {})};
        // From the end of a plain step the way mostly goes on by another.
        const bool may_land = may_land_ && !departure.side.valid();
        if (!departure.side.valid()) departure = leave(tin_, at_, end_, first_look());
        switch (departure.kind) {
            case Departure::Kind::AlongEdge:
                if (!follow(departure)) return false;
                break;
            case Departure::Kind::ThroughEdge: {
                Side exit = departure.side;
                const bool lands = may_land && lands_in(exit);
                if (!lands && !stride(exit)) return false;
                if (!exit.valid()) break;
                if (lands || (may_land_ && lands_in(exit))) {
                    land(exit);
                } else if (!cross(exit)) {
                    return false;
                }
                break;
            }
            case Departure::Kind::Outside:
                // Along edges rather than through the air: a chain is to have no gap but for
                // rounding.
                if (enter_other_fan(std::min(near_, reach_of_rounding_))) break;
                if (const Side edge = detour(along(end_)); edge.valid()) {
                    step_along(edge, far_end(edge));
                } else if (snap_ > 0.0 && enter_other_fan(near_)) {
                    break;
                } else if (is_within(tin_.plan(at_), end_, near_)) {
                    // The end is outside, but one with this vertex to within rounding.
                    log_elevation(1.0);
                    return is_as_promised();
                } else {
                    leave_mesh();
                }
                break;
        }
    }
}

/// The side from the vertex where the march stands at which to look for the way on.
Side March::first_look() const {
    const bool is_known = way_on_.valid() && tin_.origin(way_on_) == at_;
    return is_known ? way_on_ : side_from(tin_, at_);
}

/// The end of the segment is where the march stands, or within snap of it.
bool March::has_arrived() const {
    const Point2 p = tin_.plan(at_);
    return p == end_ || (corner_reach() > 0.0 && is_within(p, end_, corner_reach()));
}

bool March::finish() {
    const bool done = !path_->closed || !at_.valid() || at_ == first_ || march_home();
    if (!at_.valid()) close_outside();
    flush_open();
    at_ = {};
    return done && within_budget() && is_as_promised();
}

/// Goes along an edge to its far end, or to the segment's end where that comes first.
bool March::follow(const Departure& departure) {
    const VertexId next = departure.along(tin_, at_);
    if (tin_.plan(next) != end_ && is_ahead(tin_.plan(next), tin_.plan(at_), end_)) {
        // The end lies on the line through both ends and before the far one: on the edge.
        return reach(settle({Location::Kind::OnEdge, departure.side, {}}, end_), false);
    }
    step_along(departure.side, next);
    return true;
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
    if (way_.meets_all)
        if (const std::optional<VertexId> met = end_within(exit, near_); met && has_way(*met))
            return connect(*met);
    while (true) {
        const Point2 right = tin_.plan(tin_.origin(exit));
        const Point2 left = tin_.plan(tin_.destination(exit));
        switch (orientation(right, left, end_)) {
            case CounterClockwise:
                if (needs_swaps && may_land_ && knows_facets_ && improves_at_once() &&
                    changed_.empty() && lands_in(exit))
                    return connect(land_beyond(exit));
                return reach(settle({Location::Kind::InTriangle, exit, {}}, end_), needs_swaps);
            case Collinear:
                return reach(settle({Location::Kind::OnEdge, exit, {}}, end_), needs_swaps);
            case Clockwise:
                break;
        }
        if (tin_.is_fixed(exit) || tin_.separates_facets(exit))
            return cross_facet_edge(exit, needs_swaps);
        if (!within_budget()) return false;
        needs_swaps = true;
        const Side entry = tin_.twin(exit);
        const VertexId apex = tin_.apex(entry);
        if ((snap_ > 0.0 || way_.meets_all) && is_ahead_within_snap(apex) && has_way(apex))
            return connect(apex);
        switch (orientation(tin_.plan(at_), end_, tin_.plan(apex))) {
            case Collinear:
                if (tin_.plan(apex) != end_ && is_ahead(tin_.plan(apex), tin_.plan(at_), end_))
                    return reach(settle({Location::Kind::InTriangle, entry, {}}, end_), true);
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
    const Side edge = needs_swaps ? Side{} : find_edge(tin_, t, at_);
    if (!edge.valid()) return connect(t);
    step_along(edge, t);
    return true;
}

/// What was measured holds the promises on the chain's distance from the input, and the mesh's
/// outline from what it was.
bool March::is_as_promised() {
    if (tally_.max_plan_deviation > std::max(options_.snap, reach_of_rounding_))
        return fail(ErrorCode::NotRepresentable,
                    "no mesh of doubles was found that holds this segment within the promised "
                    "distance; move it a little");
    if (outline_bend_ > reach_of_rounding_)
        return fail(ErrorCode::NotRepresentable,
                    "no mesh of doubles was found that holds this segment and the outline, which "
                    "it meets too often in one place; move it a little");
    return true;
}

/// Looks at all limits, and for how many steps none of them can be passed.
bool March::look_at_limits() {
    // A straight way meets each triangle once; the rest is room for what rounding repeats.
    const std::uint64_t most_steps = 4 * tin_.triangle_count() + 1024;
    if (steps_ >= most_steps)
        return fail(ErrorCode::StepBudget,
                    "a defect of the program, not of the request: the march did not end within its "
                    "budget of steps; nothing was changed; report it with the request");
    if (!has_ids()) return false;
    const std::uint64_t crossings = tally_.crossings + tally_.self_crossings;
    if (crossings > limits_.max_crossings)
        return fail(ErrorCode::CrossingBudget,
                    "the request crosses more edges than allowed; send it in parts");
    const std::uint64_t triangles = tin_.triangle_count() - surgery_.record().triangle_count;
    if (triangles > limits_.max_new_triangles)
        return fail(ErrorCode::TriangleBudget,
                    "the request makes more triangles than allowed; send it in parts");
    constexpr std::uint64_t kAskEvery = 256;
    covered_ = std::min({kAskEvery - 1, most_steps - steps_ - 1,
                         (limits_.max_crossings - crossings) / kMostOfAStep,
                         (limits_.max_new_triangles - triangles) / kMostOfAStep, ids_left() - 1});
    steps_ += covered_ + 1;
    const bool asks = asked_ >= kAskEvery;
    asked_ = (asks ? 0 : asked_) + covered_ + 1;
    if (!asks) return true;
    if (limits_.progress != nullptr && limits_.progress->is_asked_for())
        limits_.progress->tell(at_.valid() ? share_along(tin_.plan(at_)) : 0.0);
    if (limits_.cancelled != nullptr && *limits_.cancelled && (*limits_.cancelled)())
        return fail(ErrorCode::Cancelled, "the request was cancelled; nothing was changed");
    return true;
}

/// For how many steps there are ids.
std::uint64_t March::ids_left() const {
    const auto left = [](std::size_t most, std::size_t used) {
        return most < used ? 0 : (most - used) / kMostOfAStep;
    };
    return std::min(left(options_.ids.triangles, tin_.triangle_count()),
                    left(options_.ids.vertices, std::max(tin_.vertex_count(), tin_.name_count())));
}

bool March::has_ids() {
    if (ids_left() > 0) return true;
    return fail(ErrorCode::IdBudget,
                "the mesh has as many triangles or vertices as can be numbered; nothing was "
                "changed; divide the terrain");
}

bool March::fail(ErrorCode code, const char* detail) {
    ErrorPlace place;
    place.path = path_index_;
    place.position = at_.valid() ? tin_.plan(at_) : start_;
    error_ = Error{code, detail, place};
    return false;
}

}  // namespace tinsmith::core
