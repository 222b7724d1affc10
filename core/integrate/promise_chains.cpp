// SPDX-License-Identifier: Apache-2.0
// The promise that each segment of a request is covered by chains.
#include <algorithm>

#include "core/integrate/box_grid.hpp"
#include "core/integrate/distance.hpp"
#include "core/integrate/promise.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::core {

namespace {

/// A stretch of a segment that a chain covers, as distances from its start.
struct Stretch {
    double from;
    double to;
};

class ChainFinder {
  public:
    ChainFinder(const Attempt& attempt, std::vector<Replaced::Edge> edges)
        : tin_(attempt.tin),
          reach_(chain_reach(attempt)),
          edges_(std::move(edges)),
          is_explained_(edges_.size(), false),
          grid_(boxes_of(tin_, edges_)) {}

    /// Whether connected edges cover the segment wherever it is on the mesh.
    bool covers(const InputSegment& s) {
        const double length = distance_between(s.a, s.b);
        double done = 0.0;
        find_stretches(s, length);
        stretches_.push_back({length, length});
        for (const Stretch& stretch : stretches_) {
            if (stretch.from > done + 2.0 * reach_ && !is_outside(s, length, done, stretch.from))
                return false;
            done = std::max(done, stretch.to);
        }
        return true;
    }

    /// An edge that is along no segment.
    std::optional<Replaced::Edge> unexplained() const {
        const auto found = std::find(is_explained_.begin(), is_explained_.end(), false);
        if (found == is_explained_.end()) return std::nullopt;
        return edges_[static_cast<std::size_t>(found - is_explained_.begin())];
    }

  private:
    static std::vector<Box> boxes_of(const Tin& tin, const std::vector<Replaced::Edge>& edges) {
        std::vector<Box> boxes;
        boxes.reserve(edges.size());
        for (const auto& [v, w] : edges)
            boxes.push_back(Box::around(tin.plan(v), tin.plan(w)));
        return boxes;
    }

    /// Pieces of chain that share a vertex are one stretch.
    void find_stretches(const InputSegment& s, double length) {
        const auto along = [&](Point2 p) {
            return ((p.x - s.a.x) * (s.b.x - s.a.x) + (p.y - s.a.y) * (s.b.y - s.a.y)) / length;
        };
        stretches_.clear();
        ends_.clear();
        for (const std::uint32_t i : grid_.near(Box::around(s.a, s.b, reach_))) {
            const auto& [v, w] = edges_[i];
            const Point2 p = tin_.plan(v), q = tin_.plan(w);
            if (distance_to_segment(p, s.a, s.b) > reach_) continue;
            if (distance_to_segment(q, s.a, s.b) > reach_) continue;
            is_explained_[i] = true;
            const auto [from, to] = std::minmax({along(p), along(q)});
            ends_.emplace_back(v, stretches_.size());
            ends_.emplace_back(w, stretches_.size());
            stretches_.push_back({from, to});
        }
        std::sort(ends_.begin(), ends_.end());
        join();
        std::sort(stretches_.begin(), stretches_.end(),
                  [](const Stretch& l, const Stretch& r) { return l.from < r.from; });
    }

    /// Each piece takes in those that share a vertex with it; what was taken in points to the piece
    /// that did.
    void join() {
        taken_.resize(stretches_.size());
        for (std::size_t i = 0; i < taken_.size(); ++i)
            taken_[i] = i;
        const auto owner = [this](std::size_t i) {
            while (taken_[i] != i)
                i = taken_[i] = taken_[taken_[i]];
            return i;
        };
        for (std::size_t k = 1; k < ends_.size(); ++k) {
            if (ends_[k].first != ends_[k - 1].first) continue;
            const std::size_t one = owner(ends_[k - 1].second), other = owner(ends_[k].second);
            if (one == other) continue;
            taken_[other] = one;
            stretches_[one] = {std::min(stretches_[one].from, stretches_[other].from),
                               std::max(stretches_[one].to, stretches_[other].to)};
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < taken_.size(); ++i)
            if (taken_[i] == i) stretches_[kept++] = stretches_[i];
        stretches_.resize(kept);
    }

    /// Whether the stretch of the segment is outside the mesh but for what is so near the outline
    /// that rounding decides. Asked once between any two places where it may cross the outline.
    bool is_outside(const InputSegment& s, double length, double from, double to) const {
        const auto at = [&](double distance) {
            return Point2{s.a.x + (s.b.x - s.a.x) * (distance / length),
                          s.a.y + (s.b.y - s.a.y) * (distance / length)};
        };
        std::vector<double> stops{from, to};
        for (const VertexId v : tin_.boundary().near(at(from), at(to))) {
            const Side edge =
                v.index() < tin_.vertex_count() ? boundary_side_from(tin_, v) : Side{};
            if (!edge.valid()) continue;
            const Point2 c = tin_.plan(v), d = tin_.plan(tin_.destination(edge));
            if (cross_properly(s.a, s.b, c, d))
                stops.push_back(length * crossing_share(s.a, s.b, c, d));
        }
        std::sort(stops.begin(), stops.end());
        for (std::size_t i = 1; i < stops.size(); ++i) {
            const double low = std::max(stops[i - 1], from), high = std::min(stops[i], to);
            if (high <= low + 4.0 * reach_) continue;
            // What is beside the outline all along may be away from it in between.
            constexpr int kSamples = 8;
            for (int k = 1; k < kSamples; ++k) {
                const Point2 p = at(low + (high - low) * (static_cast<double>(k) / kSamples));
                const bool is_inside =
                    locate(tin_, p, tin_.hint(p)).kind != Location::Kind::Outside;
                if (is_inside && !is_near_outline(p)) return false;
            }
        }
        return true;
    }

    bool is_near_outline(Point2 p) const {
        const double wide = 2.0 * reach_;
        const std::vector<VertexId> around =
            tin_.boundary().near({p.x - wide, p.y - wide}, {p.x + wide, p.y + wide});
        return std::any_of(around.begin(), around.end(), [&](VertexId v) {
            const Side edge =
                v.index() < tin_.vertex_count() ? boundary_side_from(tin_, v) : Side{};
            return edge.valid() &&
                   distance_to_segment(p, tin_.plan(v), tin_.plan(tin_.destination(edge))) <= wide;
        });
    }

    const Tin& tin_;
    double reach_;
    std::vector<Replaced::Edge> edges_;
    std::vector<bool> is_explained_;
    BoxGrid grid_;
    std::vector<Stretch> stretches_;                      ///< of the segment at hand
    std::vector<std::pair<VertexId, std::size_t>> ends_;  ///< of pieces of it
    std::vector<std::size_t> taken_;                      ///< by piece
};

}  // namespace

std::optional<BrokenPromise> find_lost_chain(const Attempt& attempt,
                                             std::span<const InputSegment> segments) {
    auto edges = chain_edges(attempt);
    if (!edges) return BrokenPromise{};
    ChainFinder finder(attempt, std::move(*edges));
    for (const InputSegment& s : segments)
        if (!finder.covers(s)) return BrokenPromise{s.shape, s.path, s.index, s.a};
    if (const auto edge = finder.unexplained())
        return BrokenPromise{0, 0, 0, attempt.tin.plan(edge->first)};
    return std::nullopt;
}

}  // namespace tinsmith::core
