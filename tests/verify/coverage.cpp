// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Directed outline of some triangles of a mesh, sorted.
template <typename IsChosen>
std::vector<Edge> outline_of(const Snapshot& mesh, const std::vector<std::uint32_t>& triangles,
                             const IsChosen& is_chosen) {
    std::vector<Edge> found;
    for (const std::uint32_t t : triangles) {
        for (unsigned i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.data.triangles[t][i];
            const std::uint32_t b = mesh.data.triangles[t][(i + 1) % 3];
            const std::uint32_t twin = mesh.stars.triangle_of(b, a);
            if (twin == kNone || !is_chosen(twin)) found.emplace_back(a, b);
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// Follows the new outline from a to b, taking the edges it passes; says what is wrong there.
void follow(const Edit& edit, Edge old, std::vector<Edge>& fresh, Faults& faults) {
    const auto& vertices = edit.after.data.vertices;
    const std::size_t old_count = edit.before.data.vertices.size();
    const Point2 a = vertices[old.first].plan(), b = vertices[old.second].plan();
    const double reach = edit.before.grid.rounding_reach();
    double last = 0.0;
    for (std::uint32_t at = old.first; at != old.second;) {
        const auto next = std::lower_bound(fresh.begin(), fresh.end(), Edge{at, 0});
        if (next == fresh.end() || next->first != at) {
            faults.push_back(words("G2 outline edge ", old.first, " to ", old.second,
                                   " is not on the outline any more, nor is a chain in its place"));
            return;
        }
        at = next->second;
        fresh.erase(next);
        const Point2 p = vertices[at].plan();
        if (at != old.second && (at < old_count || !is_within(p, a, b, reach)))
            faults.push_back(words("G2 outline vertex ", at, " at ", p.x, " ", p.y, " is ",
                                   distance_to(p, a, b), " off the old outline"));
        const double along = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y);
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        if (at != old.second && along < last - reach * length)
            faults.push_back(words("G2 the outline runs back at vertex ", at));
        last = along;
    }
}

}  // namespace

Faults check_coverage(const Edit& edit, Change& change) {
    Faults faults;
    const core::MeshData &before = edit.before.data, &after = edit.after.data;
    if (after.vertices.size() < before.vertices.size() ||
        after.triangles.size() < before.triangles.size())
        return {"G4 there are fewer vertices or triangles than before"};
    for (std::size_t v = 0; v < before.vertices.size(); ++v)
        if (before.vertices[v].plan() != after.vertices[v].plan())
            faults.push_back(words("G4 old vertex ", v, " moved"));
    change.was_removed.assign(before.triangles.size(), false);
    for (std::uint32_t t = 0; t < after.triangles.size(); ++t) {
        if (t < before.triangles.size()) {
            if (before.triangles[t] == after.triangles[t]) continue;
            change.removed.push_back(t);
            change.was_removed[t] = true;
        }
        change.added.push_back(t);
    }
    const auto was_removed = [&](std::uint32_t t) { return change.was_removed[t]; };
    const auto was_added = [&](std::uint32_t t) {
        return t >= change.was_removed.size() || change.was_removed[t];
    };
    const auto old_outline = outline_of(edit.before, change.removed, was_removed);
    const auto new_outline = outline_of(edit.after, change.added, was_added);
    std::vector<Edge> gone, fresh;
    std::set_difference(old_outline.begin(), old_outline.end(), new_outline.begin(),
                        new_outline.end(), std::back_inserter(gone));
    std::set_difference(new_outline.begin(), new_outline.end(), old_outline.begin(),
                        old_outline.end(), std::back_inserter(fresh));
    for (const Edge& old : gone) {
        if (edit.before.stars.triangle_of(old.second, old.first) == kNone)
            follow(edit, old, fresh, faults);
        else
            faults.push_back(words("G4 the changed triangles have another outline at ", old.first,
                                   " to ", old.second));
    }
    if (!fresh.empty())
        faults.push_back(words("G2 the plan has an outline that it had not, at ",
                               fresh.front().first, " to ", fresh.front().second));
    return faults;
}

}  // namespace tinsmith::verify
