// SPDX-License-Identifier: Apache-2.0
// The promise that chains along paths with elevations of their own have these.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/integrate/box_grid.hpp"
#include "core/integrate/distance.hpp"
#include "core/integrate/promise.hpp"
#include "core/mesh/walk.hpp"

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

/// How far along the segment p is, as a share of it.
double share_along(const InputSegment& s, Point2 p) {
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
    return ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
}

bool is_off_mesh(const Tin& tin, const InputSegment& s, Point2 p) {
    const double share = std::clamp(share_along(s, p), 0.0, 1.0);
    const Point2 q{s.a.x + share * (s.b.x - s.a.x), s.a.y + share * (s.b.y - s.a.y)};
    return locate(tin, q, tin.hint(q)).kind == Location::Kind::Outside;
}

/// The segments of a request by their boxes.
class SegmentFinder {
  public:
    SegmentFinder(const Tin& tin, std::vector<InputSegment> segments, double reach)
        : tin_(tin),
          segments_(std::move(segments)),
          reach_(reach),
          grid_(boxes_of(segments_, reach)) {}

    const InputSegment& any() const { return segments_.front(); }

    /// The first that has all the vertices within reach and that `wanted` takes.
    template <typename Wanted>
    const InputSegment* find(std::initializer_list<VertexId> vertices, const Wanted& wanted) {
        const Point2 first = tin_.plan(*vertices.begin());
        for (const std::uint32_t i : grid_.near(Box::around(first, first))) {
            const InputSegment& s = segments_[i];
            const bool is_on = std::all_of(vertices.begin(), vertices.end(), [&](VertexId v) {
                return distance_to_segment(tin_.plan(v), s.a, s.b) <= reach_;
            });
            if (is_on && wanted(s)) return &s;
        }
        return nullptr;
    }

  private:
    static std::vector<Box> boxes_of(const std::vector<InputSegment>& segments, double reach) {
        std::vector<Box> boxes;
        boxes.reserve(segments.size());
        for (const InputSegment& s : segments)
            boxes.push_back(Box::around(s.a, s.b, reach));
        return boxes;
    }

    const Tin& tin_;
    std::vector<InputSegment> segments_;
    double reach_;
    BoxGrid grid_;
};

}  // namespace

std::optional<BrokenPromise> find_wrong_elevation(const Attempt& attempt,
                                                  std::span<const InputSegment> segments) {
    if (attempt.options.on_crossing == OnCrossing::Old || attempt.options.snap > 0.0)
        return std::nullopt;
    const auto path_of = [&](const InputSegment& s) -> const Path& {
        return attempt.shapes[s.shape].paths[s.path];
    };
    std::vector<InputSegment> with_elevations;
    for (const InputSegment& s : segments)
        if (!path_of(s).elevations.empty()) with_elevations.push_back(s);
    if (with_elevations.empty()) return std::nullopt;
    const Tin& tin = attempt.tin;
    SegmentFinder own(tin, std::move(with_elevations), attempt.reach);
    SegmentFinder all(tin, {segments.begin(), segments.end()}, attempt.reach);
    // Beside a path that is off the mesh, if by rounding alone, an edge of another one is not its.
    const auto is_along = [&](VertexId v, VertexId w, const InputSegment& s) {
        if (!is_off_mesh(tin, s, tin.plan(v)) || !is_off_mesh(tin, s, tin.plan(w))) return true;
        return all.find({v, w}, [&](const InputSegment& other) {
            return &path_of(other) != &path_of(s);
        }) == nullptr;
    };
    const auto is_right = [&](VertexId v) {
        return own.find({v}, [&](const InputSegment& s) {
            return is_elevation_along(path_of(s), s, tin.plan(v), tin.vertex(v).z, attempt.reach);
        }) != nullptr;
    };
    std::vector<VertexId> vertices;
    const auto edges = chain_edges(attempt);
    for (const auto& edge : *edges) {
        const VertexId v = edge.first, w = edge.second;
        if (own.find({v, w}, [&](const InputSegment& s) { return is_along(v, w, s); }) != nullptr)
            vertices.insert(vertices.end(), {v, w});
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexId v : vertices) {
        if (is_right(v)) continue;
        // The end of a constraint from before that is almost along the path is not of it.
        const auto& old = attempt.replaced.constraints();
        if (std::any_of(old.begin(), old.end(),
                        [v](const auto& edge) { return edge.first == v || edge.second == v; }))
            continue;
        // Beside a chain that has the path's elevations there, it is of another path.
        const Point2 p = tin.plan(v);
        const bool is_beside = std::any_of(edges->begin(), edges->end(), [&](const auto& edge) {
            const VertexId from = edge.first, to = edge.second;
            return own.find({v, from, to},
                            [&](const InputSegment& s) {
                                const auto [low, high] = std::minmax(
                                    {share_along(s, tin.plan(from)), share_along(s, tin.plan(to))});
                                return low <= share_along(s, p) && share_along(s, p) <= high;
                            }) != nullptr &&
                   is_right(from) && is_right(to);
        });
        if (is_beside) continue;
        const InputSegment* found = own.find({v}, [](const InputSegment&) { return true; });
        const InputSegment& s = found != nullptr ? *found : own.any();
        return BrokenPromise{s.shape, s.path, s.index, p};
    }
    return std::nullopt;
}

}  // namespace tinsmith::core
