// SPDX-License-Identifier: Apache-2.0
#include "api/edge_chains.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace tinsmith::api {
namespace {

class Chainer {
  public:
    Chainer(std::span<const std::array<std::uint32_t, 2>> edges,
            const std::function<std::uint32_t(std::size_t)>& group_of)
        : edges_(edges), group_of_(group_of), used_(edges.size()) {
        ends_.reserve(2 * edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            for (const std::uint32_t vertex : edges[i])
                ends_.emplace_back(vertex, i);
        }
        std::sort(ends_.begin(), ends_.end());
    }

    std::vector<std::vector<std::uint32_t>> chain() {
        std::vector<std::vector<std::uint32_t>> lines;
        for (std::size_t first = 0; first < edges_.size(); ++first) {
            if (used_[first]) continue;
            used_[first] = true;
            const auto& [a, b] = edges_[first];
            std::vector<std::uint32_t> ahead = walk(first, b);
            std::vector<std::uint32_t> line = walk(first, a);
            std::reverse(line.begin(), line.end());
            line.push_back(a);
            line.push_back(b);
            line.insert(line.end(), ahead.begin(), ahead.end());
            lines.push_back(std::move(line));
        }
        return lines;
    }

  private:
    /// The vertices that follow on the end `at` of an edge. Ends: each step uses an edge up.
    std::vector<std::uint32_t> walk(std::size_t edge, std::uint32_t at) {
        std::vector<std::uint32_t> vertices;
        while (const auto next = edge_after(edge, at)) {
            edge = *next;
            used_[edge] = true;
            at = edges_[edge][0] == at ? edges_[edge][1] : edges_[edge][0];
            vertices.push_back(at);
        }
        return vertices;
    }

    std::optional<std::size_t> edge_after(std::size_t edge, std::uint32_t at) const {
        const auto first =
            std::lower_bound(ends_.begin(), ends_.end(), std::pair(at, std::size_t{0}));
        if (ends_.end() - first < 2 || first[1].first != at) return std::nullopt;
        if (ends_.end() - first > 2 && first[2].first == at) return std::nullopt;
        const std::size_t other = first->second == edge ? first[1].second : first->second;
        if (used_[other]) return std::nullopt;
        if (group_of_ && group_of_(other) != group_of_(edge)) return std::nullopt;
        return other;
    }

    std::span<const std::array<std::uint32_t, 2>> edges_;
    const std::function<std::uint32_t(std::size_t)>& group_of_;
    std::vector<bool> used_;
    std::vector<std::pair<std::uint32_t, std::size_t>> ends_;  ///< vertex, edge
};

}  // namespace

std::vector<std::vector<std::uint32_t>> chain_edges(
    std::span<const std::array<std::uint32_t, 2>> edges,
    const std::function<std::uint32_t(std::size_t edge)>& group_of) {
    return Chainer(edges, group_of).chain();
}

}  // namespace tinsmith::api
