// SPDX-License-Identifier: Apache-2.0
// Swapping edges out of the way of a constraint between two vertices.
#include <algorithm>

#include "core/integrate/march.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

using enum Orientation;

namespace {

constexpr const char* kNoWay =
    "rounding leaves no way along this segment within the promised distance; move it a little";

}  // namespace

/// Goes to vertex t by constrained edges: straight, by exact predicates on the vertices as they
/// are. Vertices met on the way, and ends of edges that rounding put into the way, become part of
/// the chain, each within rounding of the input segment.
bool March::connect(VertexId t) {
    const VertexId from = at_;
    std::vector<VertexId> targets{t};
    while (!targets.empty()) {
        if (!within_budget()) return false;
        const VertexId target = targets.back();
        const Point2 goal = tin_.plan(target);
        if (at_ == target || tin_.plan(at_) == goal || (at_ != from && is_passed(goal))) {
            targets.pop_back();
            continue;
        }
        const std::optional<VertexId> next = collect_corridor(target);
        if (const Side edge = next ? Side{} : detour(along(goal)); edge.valid()) {
            step_along(edge, far_end(edge));
            continue;
        }
        if (!next) return fail(ErrorCode::NotRepresentable, kNoWay);
        if (*next != target && !corridor_.empty()) {
            if (std::find(targets.begin(), targets.end(), *next) != targets.end() || *next == at_)
                return fail(ErrorCode::NotRepresentable, kNoWay);
            targets.push_back(*next);
            is_delicate_ = true;
            continue;
        }
        if (!clear_corridor(*next)) return false;
        step_along(find_edge(tin_, *next, at_), *next);
    }
    return true;
}

/// Whether the march stands beyond the position, which is not the segment's end.
bool March::is_passed(Point2 goal) const {
    return goal != end_ && !is_ahead_of(tin_.plan(at_), goal);
}

/// Whether `connect` finds a first step towards t.
bool March::has_way(VertexId t) {
    return collect_corridor(t).has_value() || edge_on_way(along(tin_.plan(t))).valid();
}

/// Collects the edges between `at_` and t that a straight line crosses. Returns t when they can all
/// be swapped away; the far end of the first edge when the line runs along it (and no corridor);
/// otherwise a vertex to go through first, which the input segment touches to within
/// rounding; nothing where there is none.
std::optional<VertexId> March::collect_corridor(VertexId t) {
    corridor_.clear();
    const Point2 from = tin_.plan(at_);
    const Point2 to = tin_.plan(t);
    const Departure departure = leave(tin_, at_, to, side_from(tin_, at_));
    if (departure.kind == Departure::Kind::Outside) return {};
    if (departure.kind == Departure::Kind::AlongEdge) return departure.along(tin_, at_);
    Side exit = departure.side;
    while (true) {
        corridor_.emplace_back(tin_.origin(exit), tin_.destination(exit));
        if (tin_.is_fixed(exit) || tin_.separates_facets(exit))
            return end_within(exit, std::max(near_, reach_of_rounding_));
        const Side entry = tin_.twin(exit);
        const VertexId apex = tin_.apex(entry);
        if (apex == t) return t;
        switch (orientation(from, to, tin_.plan(apex))) {
            case Collinear:
                return apex;
            case CounterClockwise:
                exit = entry.next();
                break;
            case Clockwise:
                exit = entry.previous();
                break;
        }
    }
}

/// An edge from where the march stands that goes on along the input segment to within rounding, no
/// farther than `limit`. Rounding bends straight outlines: the way along one may leave the mesh.
/// The nearest end, but one that is no step away only where there is no other: it may lead nowhere.
Side March::edge_on_way(double limit) const {
    const double here = along(tin_.plan(at_));
    const double step = here + reach_of_rounding_ * length_;
    Side best;
    double best_along = here;
    for_each_side_at(tin_, at_, [&](Side edge) {
        const Point2 p = tin_.plan(far_end(edge));
        const double there = along(p);
        if (there <= here || there > limit || !is_near_segment(p, near_)) return;
        const bool is_better = best_along > step ? there > step && there < best_along
                                                 : there > step || there > best_along;
        if (best.valid() && !is_better) return;
        best = edge;
        best_along = there;
    });
    return best;
}

/// Takes `edge_on_way`, once from each vertex: the straight way may lead back to it.
Side March::detour(double limit) {
    if (detours_.contains(at_)) return {};
    const Side edge = edge_on_way(limit);
    if (edge.valid()) {
        detours_.insert(at_);
        is_delicate_ = true;
    }
    return edge;
}

/// The other end of an edge at the vertex where the march stands.
VertexId March::far_end(Side edge) const {
    return tin_.origin(edge) == at_ ? tin_.destination(edge) : tin_.origin(edge);
}

/// Swaps all edges of the corridor away, so that at_ and t are joined. An edge whose two triangles
/// are not convex together waits for its neighbours' swaps. Ends: in a corridor some swap is always
/// possible, and rounds without one, or too many with, stop the march.
/// Source: Sloan 1993; Stanchev & Paraskevov 2020.
bool March::clear_corridor(VertexId t) {
    const Point2 from = tin_.plan(at_);
    const Point2 to = tin_.plan(t);
    for (const auto& [p, q] : corridor_)
        changed_.insert(changed_.end(), {p, q});
    std::size_t rounds = 4 * corridor_.size() + 8;
    while (!corridor_.empty()) {
        bool swapped = false;
        waiting_.clear();
        for (const auto& [p, q] : corridor_) {
            const Side side = find_edge(tin_, p, q);
            const Point2 a = tin_.plan(tin_.origin(side));
            const Point2 b = tin_.plan(tin_.destination(side));
            const VertexId c = tin_.apex(side);
            const VertexId d = tin_.apex(tin_.twin(side));
            if (!is_left(a, tin_.plan(d), tin_.plan(c)) ||
                !is_left(tin_.plan(d), b, tin_.plan(c))) {
                waiting_.emplace_back(p, q);
                continue;
            }
            surgery_.swap_edge(side);
            ++tally_.edges_swapped;
            swapped = true;
            if (c == at_ || c == t || d == at_ || d == t) continue;
            if (orientation(from, to, tin_.plan(c)) != orientation(from, to, tin_.plan(d)))
                waiting_.emplace_back(c, d);
        }
        if (!swapped || --rounds == 0)
            return fail(ErrorCode::StepBudget,
                        "a defect of the program, not of the request: swaps did not clear the way "
                        "within their budget; nothing was changed; report it with the request");
        corridor_.swap(waiting_);
    }
    return true;
}

}  // namespace tinsmith::core
