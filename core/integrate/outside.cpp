// SPDX-License-Identifier: Apache-2.0
// Where paths run outside the mesh: concave outlines, holes, between components.
#include <algorithm>

#include "core/integrate/distance.hpp"
#include "core/integrate/march.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

using enum Orientation;

/// From outside: goes to the segment's next meeting with the mesh. False: there is none, the
/// segment ends outside (or the march stopped, see `error`).
bool March::enter() {
    while (!at_.valid()) {
        if (!within_budget()) return false;
        const std::optional<Entry> entry = next_entry();
        if (!entry) {
            outside_.push_back(end_);
            return false;
        }
        if (!enter_by(*entry)) return false;
    }
    return true;
}

/// Position along the segment, as the projection on it: 0 at its start.
double March::along(Point2 p) const {
    return (p.x - start_.x) * (end_.x - start_.x) + (p.y - start_.y) * (end_.y - start_.y);
}

/// All places where the segment may meet the boundary, in order along it. Once for each segment
/// that gets outside, so that one which leaves the mesh a thousand times looks them up once.
void March::collect_entries() {
    entries_known_ = true;
    entries_.clear();
    next_entry_ = 0;
    farthest_visit_ = -reach_of_rounding_ * length_;
    for (const VertexId v : boundary_visits_)
        farthest_visit_ = std::max(farthest_visit_, along(tin_.plan(v)));
    for (const VertexId v : tin_.boundary().near(start_, end_, reach_of_rounding_))
        if (const std::optional<Entry> entry = entry_at(v)) entries_.push_back(*entry);
    std::sort(entries_.begin(), entries_.end(), [](const Entry& l, const Entry& r) {
        return l.along != r.along ? l.along < r.along : l.vertex < r.vertex;
    });
}

/// How the segment meets the boundary edge that starts at v, or v itself, coming from outside.
std::optional<March::Entry> March::entry_at(VertexId v) {
    if (v.index() >= tin_.vertex_count()) return {};
    const Side edge = boundary_side_from(tin_, v);
    if (!edge.valid()) return {};
    const Point2 a = tin_.plan(v);
    const Point2 b = tin_.plan(tin_.destination(edge));
    if (is_near_edge(edge, end_, reach_of_rounding_ * way_.edge_nearness) && can_split(edge, end_))
        return Entry{along(end_), v, edge, true};
    const Orientation turn_a = orientation(start_, end_, a);
    if (turn_a == Collinear) {
        const bool is_behind = a != start_ && !is_ahead(start_, end_, a);
        const bool is_beyond = a != end_ && !is_ahead(end_, start_, a);
        if (is_behind || is_beyond) return {};
        return Entry{along(a), v, {}};
    }
    const Orientation turn_b = orientation(start_, end_, b);
    if (turn_b == Collinear || turn_a == turn_b) return {};
    // The mesh is on the left of a -> b: the segment enters from its right.
    if (orientation(a, b, start_) != Clockwise || orientation(a, b, end_) == Clockwise) return {};
    return Entry{along(intersection(edge)), v, edge};
}

/// The first meeting beyond the last one. Meetings within rounding of the last count as beyond it
/// unless they are of the same edges and vertices: components may touch.
std::optional<March::Entry> March::next_entry() {
    if (!entries_known_) collect_entries();
    const double rounding = reach_of_rounding_ * length_;
    while (next_entry_ < entries_.size() &&
           entries_[next_entry_].along < farthest_visit_ - rounding)
        ++next_entry_;
    for (std::size_t i = next_entry_; i < entries_.size(); ++i) {
        const VertexId v = entries_[i].vertex;
        if (spent_edges_.contains(v)) continue;
        // The mesh has changed since: the edge may have been split, here or by the way inside.
        const std::optional<Entry> entry = entry_at(v);
        if (!entry || entry->along < farthest_visit_ - rounding) continue;
        if (entry->along > farthest_visit_ + rounding) return entry;
        const bool is_known =
            was_here(v) || (entry->edge.valid() && was_here(tin_.destination(entry->edge)));
        if (entry->ends_here || !is_known) return entry;
    }
    return {};
}

/// Whether the segment met the boundary at v, or stood there just before it last did.
bool March::was_here(VertexId v) const {
    if (boundary_visits_.contains(v)) return true;
    if (tally_.chains.empty() || tally_.chains.back().path != path_index_) return false;
    const std::vector<VertexId>& chain = tally_.chains.back().vertices;
    const double rounding = reach_of_rounding_ * length_;
    for (auto w = chain.rbegin(); w != chain.rend(); ++w) {
        if (*w == v) return true;
        if (along(tin_.plan(*w)) < farthest_visit_ - rounding) break;
    }
    return false;
}

/// The boundary edge next to the position, where it is on it to within rounding.
Location March::locate_on_boundary(Point2 p) const {
    for (const VertexId v : tin_.boundary().near(p, p, reach_of_rounding_)) {
        if (v.index() >= tin_.vertex_count()) continue;
        const Side edge = boundary_side_from(tin_, v);
        if (edge.valid() && is_near_edge(edge, p, reach_of_rounding_ * way_.edge_nearness) &&
            can_split(edge, p))
            return {Location::Kind::OnEdge, edge, {}};
    }
    return {};
}

/// Stands on the boundary at the entry, if it is not one that the segment had already: at an end of
/// the edge that is on the segment to within rounding, else where the segment crosses it.
bool March::enter_by(const Entry& entry) {
    VertexId v = entry.vertex;
    if (entry.edge.valid()) {
        const bool ends_here = entry.ends_here;
        is_delicate_ = is_delicate_ || ends_here;
        std::optional<VertexId> met = end_within(entry.edge, near_);
        const std::optional<Point2> p = ends_here ? end_ : find_split(entry.edge);
        is_delicate_ = is_delicate_ || (!met && !p);
        if (!met && !p) met = end_within(entry.edge, std::max(near_, reach_of_rounding_));
        if (met && !ends_here) {
            // Back at a vertex that the segment left: this edge brings nothing new.
            if (boundary_visits_.contains(*met)) {
                spent_edges_.insert(v);
                is_delicate_ = true;
                return true;
            }
            v = *met;
        } else if (p) {
            if (!ends_here) count_crossing(entry.edge);
            v = place({Location::Kind::OnEdge, entry.edge, {}}, *p);
        } else if (split_beyond(entry.edge) || absorb_needle_at(entry.edge)) {
            return true;  // the entry is looked up anew
        } else {
            return fail(ErrorCode::NotRepresentable,
                        "no mesh of doubles holds this segment where it enters the mesh; move it");
        }
    }
    visit_boundary(v);
    tally_.met_mesh = true;
    outside_.push_back(tin_.plan(v));
    close_outside();
    tally_.chains.push_back({path_index_, {}});
    stand_on(v);
    return true;
}

void March::visit_boundary(VertexId v) {
    boundary_visits_.insert(v);
    farthest_visit_ = std::max(farthest_visit_, along(tin_.plan(v)));
}

/// Where fans touch or all but touch, a vertex that is on one of them may be one with a vertex of
/// another, or lie inside another by exact predicates, and the way may go on there: stands on a
/// vertex of that fan within the distance, once from each vertex. False: there is no such fan.
bool March::enter_other_fan(double distance) {
    if (detours_.contains(at_)) return false;
    const VertexId v = vertex_of_other_fan(distance);
    if (!v.valid()) return false;
    is_delicate_ = true;
    detours_.insert(at_);
    visit_boundary(at_);
    // What is farther than rounding is a part outside: without it the line would not be closed.
    if (distance_between(tin_.plan(at_), tin_.plan(v)) > reach_of_rounding_) {
        outside_ = {tin_.plan(at_), tin_.plan(v)};
        close_outside();
    }
    tally_.chains.push_back({path_index_, {}});
    stand_on(v);
    if (v != at_) detours_.insert(v);
    return true;
}

VertexId March::vertex_of_other_fan(double distance) {
    const Point2 p = tin_.plan(at_);
    const std::vector<VertexId> around = tin_.boundary().near(p, p, distance);
    for (const VertexId v : around) {
        if (v == at_ || v.index() >= tin_.vertex_count() || !is_near_segment(tin_.plan(v), near_))
            continue;
        const Point2 q = tin_.plan(v);
        if ((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) > distance * distance ||
            q == end_ || along(q) < along(p) || find_edge(tin_, at_, v).valid() ||
            detours_.contains(v))
            continue;
        if (leave(tin_, v, end_, side_from(tin_, v)).kind != Departure::Kind::Outside) return v;
    }
    for (const VertexId v : around) {
        if (v == at_ || v.index() >= tin_.vertex_count()) continue;
        Location found;
        for_each_side_at(tin_, v, [&](Side side) {
            for (const Side beside : {side, tin_.twin(side)})
                if (beside.valid() && found.kind == Location::Kind::Outside)
                    found = locate_beside(beside.triangle(), p);
        });
        if (found.kind != Location::Kind::Outside) return place(found, p);
    }
    return {};
}

/// Where p lies in a triangle that does not touch the vertex where the march stands, nor has a
/// corner at p; Outside where it does not.
Location March::locate_beside(TriangleId t, Point2 p) const {
    const auto& corners = tin_.triangle(t).vertices;
    Location here{Location::Kind::InTriangle, {t, 0}, {}};
    for (unsigned i = 0; i < 3; ++i) {
        const Point2 corner = tin_.plan(corners[i]);
        if (corners[i] == at_ || corner == p) return {};
        switch (orientation(corner, tin_.plan(corners[Side::next_of(i)]), p)) {
            case Clockwise:
                return {};
            case Collinear:
                here = {Location::Kind::OnEdge, {t, i}, {}};
                break;
            case CounterClockwise:
                break;
        }
    }
    return here;
}

/// Whether the march stands within the distance of either end of the segment.
bool March::is_one_with_end(double distance) const {
    const Point2 p = tin_.plan(at_);
    return distance_between(p, end_) <= distance || distance_between(p, start_) <= distance;
}

/// Leaves the mesh from the vertex where the march stands.
void March::leave_mesh() {
    if (options_.snap > 0.0 || is_one_with_end(2.0 * reach_of_rounding_)) is_delicate_ = true;
    visit_boundary(at_);
    outside_.assign(1, tin_.plan(at_));
    at_ = {};
}

/// Lists the stretch outside (or the path's only point), unless it is of no length, which happens
/// where components touch.
void March::close_outside() {
    const bool has_length =
        outside_.size() == 1 || std::any_of(outside_.begin(), outside_.end(),
                                            [this](Point2 p) { return p != outside_.front(); });
    if (has_length) tally_.outside.push_back({path_index_, outside_});
    outside_.clear();
}

}  // namespace tinsmith::core
