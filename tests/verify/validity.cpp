// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

/// Whether the corners around v are one fan, open or closed. Requires: no `next` twice.
bool is_one_fan(const Snapshot& mesh, std::uint32_t v) {
    const auto star = mesh.stars.around(v);
    // An open fan begins at the one edge that no other corner ends with.
    const Corner* begin = &star.front();
    for (const Corner& corner : star)
        if (mesh.stars.triangle_of(corner.next, v) == kNone) begin = &corner;
    std::size_t count = 1;
    for (const Corner* at = begin; count <= star.size(); ++count) {
        const auto following =
            std::lower_bound(star.begin(), star.end(), at->last,
                             [](const Corner& l, std::uint32_t r) { return l.next < r; });
        if (following == star.end() || following->next != at->last || &*following == begin) break;
        at = &*following;
    }
    return count == star.size();
}

}  // namespace

Faults check_indices(const core::MeshData& mesh) {
    Faults faults;
    const auto out_of_range = [&](std::uint32_t v) { return v >= mesh.vertices.size(); };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        if (out_of_range(a) || out_of_range(b) || out_of_range(c))
            faults.push_back(words("G1 triangle ", t, " names a vertex that is not there"));
        else if (a == b || b == c || c == a)
            faults.push_back(words("G1 triangle ", t, " names a vertex twice"));
    }
    for (const auto& [a, b] : mesh.constraints)
        if (out_of_range(a) || out_of_range(b))
            faults.push_back("G1 a constraint names a vertex that is not there");
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Point3& p = mesh.vertices[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            faults.push_back(words("G1 vertex ", v, " is not finite"));
    }
    if (mesh.triangles.empty()) faults.push_back("G1 there is no triangle");
    return faults;
}

Faults check_validity(const Snapshot& mesh) {
    Faults faults;
    for (std::uint32_t t = 0; t < mesh.data.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.grid.corners(t);
        if (side_of(a, b, c) <= 0)
            faults.push_back(words("G1 triangle ", t, " is not counter-clockwise"));
    }
    for (std::uint32_t v = 0; v < mesh.data.vertices.size(); ++v) {
        const auto star = mesh.stars.around(v);
        if (star.empty()) {
            faults.push_back(words("G1 no triangle uses vertex ", v));
            continue;
        }
        const auto same_next = [](const Corner& l, const Corner& r) { return l.next == r.next; };
        const auto twice = std::adjacent_find(star.begin(), star.end(), same_next);
        if (twice != star.end())
            faults.push_back(words("G1 two triangles have the edge ", v, " to ", twice->next));
        else if (!is_one_fan(mesh, v))
            faults.push_back(words("G1 the triangles around vertex ", v, " are not one fan"));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> marked;
    for (const auto& [a, b] : mesh.data.constraints) {
        marked.push_back(std::minmax(a, b));
        if (mesh.stars.triangle_of(a, b) == kNone && mesh.stars.triangle_of(b, a) == kNone)
            faults.push_back(words("G1 constraint ", a, " to ", b, " is not an edge"));
    }
    std::sort(marked.begin(), marked.end());
    if (std::adjacent_find(marked.begin(), marked.end()) != marked.end())
        faults.push_back("G1 a constraint is listed twice");
    return faults;
}

}  // namespace tinsmith::verify
