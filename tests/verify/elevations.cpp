// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

/// Elevation of a path at the position of a segment of it that is nearest to p, and how much it may
/// be off because p is up to `reach` from there.
struct Elevation {
    double z;
    double slack;
};

Elevation elevation_along(const Segment& s, Point2 p, double reach) {
    const double from = s.path->elevations[s.index];
    const double to = s.path->elevations[(s.index + 1) % s.path->points.size()];
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, square = dx * dx + dy * dy;
    const double share = std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / square, 0.0, 1.0);
    const double slope = std::fabs(to - from) / std::sqrt(square);
    const double rounding = 1e-12 * (std::fabs(from) + std::fabs(to));
    return {from + share * (to - from), 2 * reach * slope + rounding};
}

/// How far along the segment p is, as a share of it.
double share_along(const Segment& s, Point2 p) {
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
    return ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
}

}  // namespace

Faults check_elevations(const Edit& edit) {
    std::vector<Segment> own = segments_of(edit.shapes);
    std::erase_if(own, [](const Segment& s) { return s.path->elevations.empty(); });
    Faults faults;
    if (own.empty() || edit.options.on_crossing == core::OnCrossing::Old || edit.options.snap > 0.0)
        return faults;
    const double reach = edit.before.grid.rounding_reach();
    const auto& vertices = edit.after.data.vertices;
    const auto is_on = [&](std::uint32_t v, const Segment& s) {
        return is_within(vertices[v].plan(), s.a, s.b, reach);
    };
    // Beside a path that is off the mesh, if by rounding alone, an edge of another one is not its.
    const std::vector<Segment> all = segments_of(edit.shapes);
    const auto is_off_mesh = [&](std::uint32_t v, const Segment& s) {
        const double share = std::clamp(share_along(s, vertices[v].plan()), 0.0, 1.0);
        const Point2 q{s.a.x + share * (s.b.x - s.a.x), s.a.y + share * (s.b.y - s.a.y)};
        return !edit.before.grid.holds(q, 0.0);
    };
    const auto is_along = [&](std::uint32_t v, std::uint32_t w, const Segment& s) {
        if (!is_on(v, s) || !is_on(w, s)) return false;
        if (!is_off_mesh(v, s) || !is_off_mesh(w, s)) return true;
        return std::none_of(all.begin(), all.end(), [&](const Segment& other) {
            return other.path != s.path && is_on(v, other) && is_on(w, other);
        });
    };
    std::vector<bool> is_in_chain(vertices.size(), false);
    for (const auto& [v, w] : edit.after.data.constraints)
        for (const Segment& s : own)
            if (is_along(v, w, s)) is_in_chain[v] = is_in_chain[w] = true;
    std::vector<std::uint32_t> right, wrong;
    std::vector<bool> is_right(vertices.size(), false);
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        if (!is_in_chain[v]) continue;
        is_right[v] = std::any_of(own.begin(), own.end(), [&](const Segment& s) {
            if (!is_on(v, s)) return false;
            const Elevation e = elevation_along(s, vertices[v].plan(), reach);
            return std::fabs(vertices[v].z - e.z) <= e.slack;
        });
        (is_right[v] ? right : wrong).push_back(v);
    }
    std::vector<bool> is_end(edit.before.data.vertices.size(), false);
    for (const auto& [v, w] : edit.before.data.constraints)
        is_end[v] = is_end[w] = true;
    for (const std::uint32_t v : wrong) {
        // An old constraint that is almost along the path is not of it.
        if (v < is_end.size() && is_end[v]) continue;
        // A vertex that is merely near may be taken for one of the chain next to it.
        const Point2 p = vertices[v].plan();
        const bool has_neighbour = std::any_of(right.begin(), right.end(), [&](std::uint32_t w) {
            return is_within(vertices[w].plan(), p, p, 4 * reach);
        });
        // Beside a chain that has the path's elevations there, it is of another path.
        const auto passes = [&](const auto& edge) {
            const std::uint32_t from = edge[0], to = edge[1];
            if (!is_right[from] || !is_right[to]) return false;
            return std::any_of(own.begin(), own.end(), [&](const Segment& s) {
                if (!is_on(v, s) || !is_on(from, s) || !is_on(to, s)) return false;
                const auto [low, high] = std::minmax(
                    {share_along(s, vertices[from].plan()), share_along(s, vertices[to].plan())});
                const double share = share_along(s, p);
                return low <= share && share <= high;
            });
        };
        const auto& edges = edit.after.data.constraints;
        if (!has_neighbour && std::none_of(edges.begin(), edges.end(), passes))
            faults.push_back(words("OWN vertex ", v, " at ", p.x, " ", p.y, " has elevation ",
                                   vertices[v].z, ", which no path brings"));
    }
    return faults;
}

}  // namespace tinsmith::verify
