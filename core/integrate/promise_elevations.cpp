// SPDX-License-Identifier: Apache-2.0
// The promise that chains along paths with elevations of their own have these.
#include <algorithm>
#include <cmath>

#include "core/integrate/box_grid.hpp"
#include "core/integrate/distance.hpp"
#include "core/integrate/promise.hpp"

namespace tinsmith::core {

namespace {

/// Whether z is the path's elevation at the place of the segment nearest to p, as far as it can be
/// told where p is up to `reach` off.
bool is_elevation_along(const Path& path, const InputSegment& s, Point2 p, double z, double reach) {
    const double from = path.elevations[s.index];
    const double to = path.elevations[(s.index + 1) % path.points.size()];
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, square = dx * dx + dy * dy;
    const double share = std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / square, 0.0, 1.0);
    const double slack = 2.0 * reach * std::fabs(to - from) / std::sqrt(square) +
                         0x1p-41 * (std::fabs(from) + std::fabs(to));
    return std::fabs(z - (from + share * (to - from))) <= slack;
}

}  // namespace

std::optional<BrokenPromise> find_wrong_elevation(const Attempt& attempt,
                                                  std::span<const InputSegment> segments) {
    if (attempt.options.on_crossing == OnCrossing::Old || attempt.options.snap > 0.0)
        return std::nullopt;
    std::vector<InputSegment> own;
    std::vector<Box> boxes;
    for (const InputSegment& s : segments) {
        if (attempt.shapes[s.shape].paths[s.path].elevations.empty()) continue;
        own.push_back(s);
        boxes.push_back(Box::around(s.a, s.b, attempt.reach));
    }
    if (own.empty()) return std::nullopt;
    BoxGrid grid(std::move(boxes));
    const Tin& tin = attempt.tin;
    const auto is_on = [&](Point2 p, const InputSegment& s) {
        return distance_to_segment(p, s.a, s.b) <= attempt.reach;
    };
    std::vector<VertexId> vertices;
    const auto edges = chain_edges(attempt);
    for (const auto& [v, w] : *edges) {
        const Point2 p = tin.plan(v), q = tin.plan(w);
        const auto& near = grid.near(Box::around(p, q));
        if (std::any_of(near.begin(), near.end(),
                        [&](std::uint32_t i) { return is_on(p, own[i]) && is_on(q, own[i]); }))
            vertices.insert(vertices.end(), {v, w});
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexId v : vertices) {
        const Point2 p = tin.plan(v);
        const auto& near = grid.near(Box::around(p, p));
        const auto found = std::find_if(near.begin(), near.end(), [&](std::uint32_t i) {
            return is_on(p, own[i]) &&
                   is_elevation_along(attempt.shapes[own[i].shape].paths[own[i].path], own[i], p,
                                      tin.vertex(v).z, attempt.reach);
        });
        if (found != near.end()) continue;
        // The end of a constraint from before that is almost along the path is not of it.
        const auto& old = attempt.replaced.constraints();
        if (std::any_of(old.begin(), old.end(),
                        [v](const auto& edge) { return edge.first == v || edge.second == v; }))
            continue;
        const InputSegment& s = near.empty() ? own.front() : own[near.front()];
        return BrokenPromise{s.shape, s.path, s.index, p};
    }
    return std::nullopt;
}

}  // namespace tinsmith::core
