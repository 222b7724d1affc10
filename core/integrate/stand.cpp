// SPDX-License-Identifier: Apache-2.0
// Where the march stands: making points vertices, and keeping the chain that it leaves behind.
#include <algorithm>
#include <cmath>

#include "core/integrate/distance.hpp"
#include "core/integrate/march.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

using enum Orientation;

namespace {

double squared_distance(Point2 p, Point2 q) {
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

/// The point of the segment a-b that is nearest to p, to within rounding.
Point2 nearest_on(Point2 a, Point2 b, Point2 p) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double share =
        std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return {a.x + dx * share, a.y + dy * share};
}

}  // namespace

/// Makes an input position, located in a triangle or on an edge, a vertex; or takes the vertex or
/// the place on an edge between facets that is within snap of it.
VertexId March::settle(const Location& location, Point2 p) {
    if (corner_reach() > 0.0 && location.kind != Location::Kind::OnVertex) {
        if (const auto vertex = vertex_within_snap(location, p)) return *vertex;
    }
    if (snap_ > 0.0 && location.kind != Location::Kind::OnVertex) {
        if (const auto found = edge_within_snap(location, p))
            return place({Location::Kind::OnEdge, found->first, {}}, found->second);
    }
    return place(location, p);
}

/// The nearest corner of the triangles that the location is in.
std::optional<VertexId> March::vertex_within_snap(const Location& location, Point2 p) const {
    std::optional<VertexId> nearest;
    double least = corner_reach() * corner_reach();
    for (const Side side : {location.side, tin_.twin(location.side)}) {
        if (!side.valid()) continue;
        for (const VertexId v : tin_.triangle(side.triangle()).vertices) {
            const double distance = squared_distance(tin_.plan(v), p);
            if (distance > least || (nearest && distance == least && *nearest < v)) continue;
            nearest = v;
            least = distance;
        }
    }
    return nearest;
}

/// The nearest side of the location's triangle that is part of the surface's shape, and the place
/// on it. Sides inside a facet are no reason to move a point.
std::optional<std::pair<Side, Point2>> March::edge_within_snap(const Location& location,
                                                               Point2 p) const {
    if (location.kind != Location::Kind::InTriangle) return {};
    std::optional<std::pair<Side, Point2>> nearest;
    double least = snap_ * snap_;
    for (unsigned i = 0; i < 3; ++i) {
        const Side side(location.side.triangle(), i);
        if (!tin_.is_fixed(side) && !tin_.separates_facets(side)) continue;
        const Point2 q =
            nearest_on(tin_.plan(tin_.origin(side)), tin_.plan(tin_.destination(side)), p);
        const double distance = squared_distance(p, q);
        if (distance > least || !can_split(side, q)) continue;
        nearest.emplace(side, q);
        least = distance;
    }
    return nearest;
}

/// Makes a position that was located a vertex, on the facet's plane or edge. One that is on an edge
/// to within rounding goes onto the edge: no needle is left between them.
VertexId March::place(Location location, Point2 p) {
    VertexId v = location.vertex;
    if (location.kind == Location::Kind::InTriangle) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(location.side.triangle(), i);
            if (is_near_edge(side, p, reach_of_rounding_ * way_.edge_nearness) &&
                can_bend(side, p) && can_split(side, p))
                location = {Location::Kind::OnEdge, side, {}};
        }
    }
    switch (location.kind) {
        case Location::Kind::InTriangle: {
            const TriangleId t = location.side.triangle();
            const std::uint32_t below = deepest_corner(t);
            v = surgery_.split_triangle(t, {p.x, p.y, elevation_in(tin_, t, p)});
            drift_.nest(v, below);
            break;
        }
        case Location::Kind::OnEdge:
            return place_on(location.side, p);
        case Location::Kind::OnVertex:
        case Location::Kind::Outside:
            return v;
    }
    changed_.push_back(v);
    return v;
}

/// Splits an edge at a position that is on it to within rounding. Inside a facet the position takes
/// its elevation from the plane; between facets from the edge, which it bends.
VertexId March::place_on(Side edge, Point2 p) {
    const Side across = tin_.twin(edge);
    if (across.valid() && !tin_.separates_facets(edge)) {
        const bool is_across = orientation(tin_.plan(tin_.origin(edge)),
                                           tin_.plan(tin_.destination(edge)), p) == Clockwise;
        const TriangleId t = is_across ? across.triangle() : edge.triangle();
        const std::uint32_t below = deepest_corner(t);
        const double strays = tin_.is_constrained(edge) ? stray_of(edge, p) : 0.0;
        const VertexId v = surgery_.split_edge(edge, {p.x, p.y, elevation_in(tin_, t, p)});
        if (strays > drift_.usual()) drift_.stray(v, strays);
        drift_.nest(v, below);
        changed_.push_back(v);
        return v;
    }
    const double bent = bends_unusually(edge, p) ? bend_of(edge, p) : 0.0;
    if (!across.valid()) outline_bend_ = std::max(outline_bend_, bent);
    const std::uint32_t below =
        std::max(drift_.nesting_of(tin_.origin(edge)), drift_.nesting_of(tin_.destination(edge)));
    const VertexId v = surgery_.split_edge(edge, {p.x, p.y, elevation_on(tin_, edge, p)});
    drift_.nest(v, below);
    if (bent > 0.0) drift_.bend(v, bent);
    changed_.push_back(v);
    return v;
}

/// False where the edge going through p is off what it was before the request by no more than the
/// rounding of one position, which is so almost always. Filtered: may be true there as well.
bool March::bends_unusually(Side edge, Point2 p) const {
    const VertexId from = tin_.origin(edge), to = tin_.destination(edge);
    if (drift_.bend_of(from) > 0.0 || drift_.bend_of(to) > 0.0) return true;
    const Point2 a = tin_.plan(from), b = tin_.plan(to);
    const AreaEstimate area = estimate_doubled_area(a, b, p);
    const double length = std::max(std::fabs(b.x - a.x), std::fabs(b.y - a.y));
    return std::fabs(area.value) + area.error > drift_.usual() * length;
}

/// How far from the edge as it was before the request it is bent when it goes through p: what its
/// ends are off it there, and p's own distance.
double March::bend_of(Side edge, Point2 p) const {
    return off_edge(edge, p, drift_.bend_of(tin_.origin(edge)),
                    drift_.bend_of(tin_.destination(edge)));
}

/// p's distance from the edge, which may end before p by rounding, and what the edge is off
/// already, between what its ends are.
double March::off_edge(Side edge, Point2 p, double at_origin, double at_destination) const {
    const Point2 a = tin_.plan(tin_.origin(edge));
    const Point2 b = tin_.plan(tin_.destination(edge));
    const double squared = squared_distance(a, b);
    const double share =
        std::clamp(((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / squared, 0.0, 1.0);
    return at_origin + (at_destination - at_origin) * share + distance_to_segment(p, a, b);
}

/// How often elevations were interpolated one from the other at most, at the triangle's corners.
std::uint32_t March::deepest_corner(TriangleId t) const {
    const auto& [a, b, c] = tin_.triangle(t).vertices;
    return std::max({drift_.nesting_of(a), drift_.nesting_of(b), drift_.nesting_of(c)});
}

/// How far from the input segments that it is part of a constrained edge is when it goes through p.
double March::stray_of(Side edge, Point2 p) const {
    return off_edge(edge, p, drift_.stray_of(tin_.origin(edge)),
                    drift_.stray_of(tin_.destination(edge)));
}

/// Whether the edge may go through p: between facets while what rounding moved it adds up to no
/// more than half the reach of rounding; as part of a chain while that stays within the reach.
bool March::can_bend(Side edge, Point2 p) const {
    if (tin_.is_constrained(edge) && stray_of(edge, p) > reach_of_rounding_) return false;
    if (tin_.twin(edge).valid() && !tin_.separates_facets(edge)) return true;
    return bend_of(edge, p) <= reach_of_rounding_ / 2.0;
}

/// Stands on a vertex, which is the chain's next.
void March::stand_on(VertexId v) {
    flush_open();
    at_ = v;
    tally_.chains.back().vertices.push_back(v);
    measure(v);
    if (!path_->elevations.empty()) log_elevation(share_along(tin_.plan(v)));
}

/// Goes along an edge from where the march stands to its other end, and constrains it.
void March::step_along(Side edge, VertexId next) {
    surgery_.mark_constrained(edge);
    if (options_.lock) surgery_.set_locked(edge, true);
    stand_on(next);
}

/// How far along the input segment the position is, from 0 to 1.
double March::share_along(Point2 p) const {
    if (p == start_ || start_ == end_) return 0.0;
    if (p == end_) return 1.0;
    return std::clamp(along(p) / (length_ * length_), 0.0, 1.0);
}

/// Notes the elevation that the path has where the march stands: linear along the input segment,
/// counted from its nearer end so that rounding shrinks towards both.
void March::log_elevation(double share) {
    if (path_->elevations.empty()) return;
    if (options_.on_crossing == OnCrossing::Old && is_on_older_constraint(at_)) return;
    const double from = path_->elevations[from_];
    const double to = path_->elevations[to_];
    const double z = share > 0.5 ? to + (from - to) * (1.0 - share) : from + (to - from) * share;
    own_elevations_.push_back({at_, z});
}

/// Whether the vertex is on a constraint that the shape did not bring.
bool March::is_on_older_constraint(VertexId v) const {
    bool found = false;
    for_each_side_at(tin_, v, [&](Side side) {
        found = found || (tin_.is_constrained(side) && !surgery_.is_fresh(side));
    });
    return found;
}

}  // namespace tinsmith::core
