// SPDX-License-Identifier: Apache-2.0
#include "core/edit/way_in.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/integrate/distance.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

using enum Orientation;

/// An edge across the line, named by its ends right and left of it.
struct Gate {
    Point2 right;
    Point2 left;
};

Gate gate_of(const Tin& tin, Point2 p, Point2 q, Side side) {
    Gate gate{tin.plan(tin.origin(side)), tin.plan(tin.destination(side))};
    if (orientation(p, q, gate.right) == CounterClockwise) std::swap(gate.right, gate.left);
    return gate;
}

/// Of two edges across the line by where the ends of the second are, seen from the first: behind
/// it (true), in front (false); nothing where that does not tell.
std::optional<bool> first_comes_first(const Gate& first, const Gate& second) {
    // What the line meets after a gate is on the right of right -> left.
    const Orientation a = orientation(first.right, first.left, second.right);
    const Orientation b = orientation(first.right, first.left, second.left);
    if (a == Collinear && b == Collinear) return false;
    if (a != CounterClockwise && b != CounterClockwise) return true;
    if (a != Clockwise && b != Clockwise) return false;
    return std::nullopt;
}

bool gate_is_before(Point2 p, Point2 q, const Gate& a, const Gate& b) {
    if (const auto told = first_comes_first(a, b)) return *told;
    const bool collinear = orientation(b.right, b.left, a.right) == Collinear &&
                           orientation(b.right, b.left, a.left) == Collinear;
    if (collinear) return false;
    if (const auto told = first_comes_first(b, a)) return !*told;
    // They cross each other, in parts of the mesh that overlap: no order is right.
    return crossing_share(p, q, a.right, a.left) < crossing_share(p, q, b.right, b.left);
}

// How far along the line, to within rounding: for sorting, never for a decision.

double share_of(const Tin& tin, Point2 p, Point2 q, VertexId vertex) {
    const double dx = q.x - p.x, dy = q.y - p.y;
    const Point2 v = tin.plan(vertex);
    return ((v.x - p.x) * dx + (v.y - p.y) * dy) / (dx * dx + dy * dy);
}

double share_of(const Tin& tin, Point2 p, Point2 q, Side side) {
    return crossing_share(p, q, tin.plan(tin.origin(side)), tin.plan(tin.destination(side)));
}

}  // namespace

bool is_before(const Tin& tin, Point2 p, Point2 q, const BoundaryContact& a,
               const BoundaryContact& b) {
    if (a.is_vertex() && b.is_vertex()) {
        const Point2 v = tin.plan(a.vertex), w = tin.plan(b.vertex);
        if (v == w) return false;
        return p.x != q.x ? (v.x < w.x) == (p.x < q.x) : (v.y < w.y) == (p.y < q.y);
    }
    if (a.is_vertex()) {
        const Gate gate = gate_of(tin, p, q, b.side);
        return orientation(gate.right, gate.left, tin.plan(a.vertex)) == CounterClockwise;
    }
    const Gate gate = gate_of(tin, p, q, a.side);
    if (b.is_vertex()) return orientation(gate.right, gate.left, tin.plan(b.vertex)) == Clockwise;
    return gate_is_before(p, q, gate, gate_of(tin, p, q, b.side));
}

std::vector<BoundaryContact> ways_in(const Tin& tin, Point2 p, Point2 q) {
    std::vector<std::pair<double, BoundaryContact>> found;
    const auto add_vertex = [&](VertexId v) {  // from p on, before q
        const Point2 at = tin.plan(v);
        if (at == q || (at != p && !(is_ahead(p, q, at) && is_ahead(q, p, at)))) return;
        if (leave(tin, v, q, side_from(tin, v)).kind != Departure::Kind::Outside)
            found.emplace_back(share_of(tin, p, q, v), BoundaryContact{{}, v});
    };
    for (const VertexId v : tin.boundary().near(p, q)) {
        if (v.index() >= tin.vertex_count()) continue;
        const Side side = boundary_side_from(tin, v);
        if (!side.valid()) continue;
        const Point2 a = tin.plan(v), b = tin.plan(tin.destination(side));
        const Orientation of_a = orientation(p, q, a);
        if (of_a == Collinear) add_vertex(v);  // each boundary vertex starts one boundary edge
        if (of_a != CounterClockwise || orientation(p, q, b) != Clockwise) continue;
        if (orientation(a, b, p) == CounterClockwise) continue;
        if (orientation(a, b, q) != CounterClockwise) continue;
        found.emplace_back(share_of(tin, p, q, side), BoundaryContact{side, {}});
    }
    std::sort(found.begin(), found.end(), [](const auto& l, const auto& r) {
        if (l.first != r.first) return l.first < r.first;
        return std::pair{l.second.side, l.second.vertex} <
               std::pair{r.second.side, r.second.vertex};
    });
    std::vector<BoundaryContact> sorted;
    sorted.reserve(found.size());
    for (const auto& [share, contact] : found) {
        // Only neighbours within rounding can be the wrong way round.
        auto place = sorted.end();
        while (place != sorted.begin() && is_before(tin, p, q, contact, *(place - 1)))
            --place;
        sorted.insert(place, contact);
    }
    return sorted;
}

}  // namespace tinsmith::core
