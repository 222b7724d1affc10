// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/promise.hpp"

#include <algorithm>

#include "core/integrate/distance.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::core {

namespace {

std::vector<InputSegment> segments_of(std::span<const Shape> shapes) {
    std::vector<InputSegment> found;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        for (std::size_t p = 0; p < shapes[s].paths.size(); ++p) {
            const Path& path = shapes[s].paths[p];
            const std::size_t count = path.points.size();
            for (std::size_t i = 1; i < count + (path.closed ? 1 : 0); ++i)
                if (path.points[i - 1] != path.points[i % count])
                    found.push_back({s, p, i - 1, path.points[i - 1], path.points[i % count]});
        }
    }
    return found;
}

/// What became of the edges that were split during the request.
class Splits {
  public:
    Splits(const Tin& tin, std::size_t first) : tin_(tin) {
        const auto& all = tin.constraint_splits();
        for (std::size_t i = first; i < all.size(); ++i)
            splits_.push_back({std::minmax(all[i].a, all[i].b), all[i].p});
        std::stable_sort(splits_.begin(), splits_.end(),
                         [](const Split& l, const Split& r) { return l.edge < r.edge; });
    }

    /// Adds the constrained edges that v-w is made of now. False: it is not there. Ends: where
    /// rounding lets edges be split back and forth, the budget does it.
    bool add_parts(VertexId v, VertexId w, std::vector<Replaced::Edge>& parts) {
        std::size_t budget = 2 * splits_.size() + 1;
        pending_.assign(1, std::minmax(v, w));
        while (!pending_.empty()) {
            const Replaced::Edge edge = pending_.back();
            pending_.pop_back();
            const Side side = find_edge(tin_, edge.first, edge.second);
            if (side.valid() && tin_.is_constrained(side)) {
                parts.push_back(edge);
                continue;
            }
            const auto split = std::lower_bound(
                splits_.begin(), splits_.end(), edge,
                [](const Split& l, const Replaced::Edge& r) { return l.edge < r; });
            if (split == splits_.end() || split->edge != edge || budget-- == 0) return false;
            pending_.emplace_back(std::minmax(edge.first, split->p));
            pending_.emplace_back(std::minmax(edge.second, split->p));
        }
        return true;
    }

  private:
    struct Split {
        Replaced::Edge edge;
        VertexId p;
    };
    const Tin& tin_;
    std::vector<Split> splits_;  ///< in order of edge
    std::vector<Replaced::Edge> pending_;
};

}  // namespace

std::optional<std::vector<Replaced::Edge>> chain_edges(const Attempt& attempt) {
    Splits splits(attempt.tin, attempt.replaced.split_count());
    std::vector<Replaced::Edge> parts;
    for (const ShapeReport& report : attempt.reports)
        for (const Chain& chain : report.chains)
            for (std::size_t i = 1; i < chain.vertices.size(); ++i)
                if (chain.vertices[i - 1] != chain.vertices[i] &&
                    !splits.add_parts(chain.vertices[i - 1], chain.vertices[i], parts))
                    return std::nullopt;
    // Constraints from before that were split are still there.
    for (const auto& [a, b] : attempt.replaced.constraints()) {
        std::vector<Replaced::Edge> old;
        if (!splits.add_parts(a, b, old)) return std::nullopt;
        const Point2 p = attempt.tin.plan(a), q = attempt.tin.plan(b);
        for (const auto& [v, w] : old)
            for (const VertexId end : {v, w})
                if (distance_to_segment(attempt.tin.plan(end), p, q) > attempt.reach)
                    return std::nullopt;
    }
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
}

double chain_reach(const Attempt& attempt) {
    // Distances are rounded: what is at the reach itself may be beyond it.
    return std::max(attempt.options.snap, attempt.reach * (1.0 - 0x1p-20));
}

std::optional<BrokenPromise> find_broken_promise(const Attempt& attempt) {
    const std::vector<InputSegment> segments = segments_of(attempt.shapes);
    if (auto broken = find_lost_chain(attempt, segments)) return broken;
    // What follows a shape that brings elevations lies on a surface that is in neither mesh.
    const auto brings_elevations = [](const Shape& shape) {
        return std::any_of(shape.paths.begin(), shape.paths.end(),
                           [](const Path& path) { return !path.elevations.empty(); });
    };
    if (std::any_of(attempt.shapes.begin(), attempt.shapes.end() - 1, brings_elevations))
        return std::nullopt;
    if (auto broken = find_needless_vertex(attempt, segments)) return broken;
    if (auto broken = find_moved_surface(attempt, segments)) return broken;
    return find_wrong_elevation(attempt, segments);
}

}  // namespace tinsmith::core
