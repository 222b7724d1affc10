// SPDX-License-Identifier: Apache-2.0
#include "tests/support/delaunay.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace tinsmith::test {

namespace {

__extension__ typedef __int128 Wide;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::int64_t area(LatticePoint a, LatticePoint b, LatticePoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d is inside the circle through a, b, c, which are counter-clockwise.
bool in_circle(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    const auto lifted = [d](LatticePoint p) {
        return Wide{p.x - d.x} * (p.x - d.x) + Wide{p.y - d.y} * (p.y - d.y);
    };
    return lifted(a) * area(d, b, c) + lifted(b) * area(d, c, a) + lifted(c) * area(d, a, b) > 0;
}

/// Adds the points from left to right, each joined to the hull edges that it sees.
Triangles sweep(const std::vector<LatticePoint>& points, const std::vector<std::uint32_t>& order) {
    Triangles triangles;
    // The first points may be on one line: the first one off it makes a fan over them.
    std::size_t apex = 2;
    while (apex < order.size() &&
           area(points[order[0]], points[order[1]], points[order[apex]]) == 0)
        ++apex;
    if (apex >= order.size()) return triangles;
    const bool is_left = area(points[order[0]], points[order[1]], points[order[apex]]) > 0;
    std::vector<std::uint32_t> hull;  // counter-clockwise
    for (std::size_t i = 0; i + 1 < apex; ++i) {
        if (is_left)
            triangles.push_back({order[i], order[i + 1], order[apex]});
        else
            triangles.push_back({order[i + 1], order[i], order[apex]});
    }
    hull.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(apex));
    if (!is_left) std::reverse(hull.begin(), hull.end());
    hull.push_back(order[apex]);
    for (std::size_t i = apex + 1; i < order.size(); ++i) {
        const std::uint32_t p = order[i];
        std::vector<std::uint32_t> next;
        const auto sees = [&](std::size_t k) {
            return area(points[hull[k]], points[hull[(k + 1) % hull.size()]], points[p]) < 0;
        };
        // Begin at an edge that p does not see, so that those it sees are one run.
        std::size_t first = 0;
        while (sees(first))
            ++first;
        std::rotate(hull.begin(), hull.begin() + static_cast<std::ptrdiff_t>(first), hull.end());
        for (std::size_t k = 0; k < hull.size(); ++k) {
            const bool before = k > 0 && sees(k - 1), here = sees(k);
            if (!before || !here) next.push_back(hull[k]);
            if (!here) continue;
            triangles.push_back({hull[(k + 1) % hull.size()], hull[k], p});
            if (!before) next.push_back(p);
        }
        hull = std::move(next);
    }
    return triangles;
}

/// Swaps edges until none has a point inside the circle of the triangle across (Lawson).
void swap_all(const std::vector<LatticePoint>& points, Triangles& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> sides;
    const auto enter = [&](std::size_t t) {
        const auto& [a, b, c] = triangles[t];
        sides[{a, b}] = sides[{b, c}] = sides[{c, a}] = t;
    };
    const auto apex_of = [&](std::size_t t, std::uint32_t a, std::uint32_t b) {
        for (const std::uint32_t v : triangles[t])
            if (v != a && v != b) return v;
        return a;
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        enter(t);
    // Each swap lowers the lifted surface, so that there is an end.
    for (bool swapped = true; swapped;) {
        swapped = false;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (unsigned i = 0; i < 3; ++i) {
                const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
                const auto twin = sides.find({b, a});
                if (twin == sides.end()) continue;
                const std::size_t u = twin->second;
                const std::uint32_t c = apex_of(t, a, b), d = apex_of(u, a, b);
                if (!in_circle(points[a], points[b], points[c], points[d])) continue;
                sides.erase({a, b});
                sides.erase({b, a});
                triangles[t] = {c, d, b};
                triangles[u] = {d, c, a};
                enter(t);
                enter(u);
                swapped = true;
                break;
            }
        }
    }
}

}  // namespace

Triangles delaunay(const std::vector<LatticePoint>& points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t l, std::uint32_t r) { return points[l] < points[r]; });
    if (order.size() < 3) return {};
    Triangles triangles = sweep(points, order);
    swap_all(points, triangles);
    return triangles;
}

}  // namespace tinsmith::test
