// SPDX-License-Identifier: Apache-2.0
#include "core/regions/constraint_history.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_set>

#include "core/mesh/walk.hpp"

namespace tinsmith::core {

ConstraintHistory::ConstraintHistory(const Tin& tin) : tin_(tin) {
    const std::vector<ConstraintSplit>& splits = tin.constraint_splits();
    splits_.reserve(splits.size());
    for (std::size_t i = 0; i < splits.size(); ++i)
        splits_.push_back({edge_key(splits[i].a, splits[i].b), i, splits[i].p});
    std::sort(splits_.begin(), splits_.end(), [](const Split& l, const Split& r) {
        return std::tie(l.edge, l.index) < std::tie(r.edge, r.index);
    });
}

std::span<const ConstraintHistory::Split> ConstraintHistory::splits_of(VertexId a,
                                                                       VertexId b) const {
    struct ByEdge {
        bool operator()(const Split& split, std::uint64_t edge) const { return split.edge < edge; }
        bool operator()(std::uint64_t edge, const Split& split) const { return edge < split.edge; }
    };
    const auto [first, last] =
        std::equal_range(splits_.begin(), splits_.end(), edge_key(a, b), ByEdge{});
    return {first, last};
}

bool ConstraintHistory::is_constrained(VertexId a, VertexId b) const {
    const Side edge = find_edge(tin_, a, b);
    return edge.valid() && tin_.is_constrained(edge);
}

// Rounding can bring an edge back that was split before: a-c-b, where c is beside the line a-b,
// leaves room for a later a-b. So the edge itself comes first, then its newest split; either way
// the line is the same to within rounding. It ends: a part is expanded by a younger split only than
// the whole was.
std::vector<VertexId> ConstraintHistory::expand(std::span<const VertexId> chain) const {
    std::vector<VertexId> expanded;
    if (chain.empty()) return expanded;
    struct Target {
        VertexId vertex;
        std::size_t since;  ///< only splits from this index on
    };
    std::vector<Target> targets;
    expanded.push_back(chain.front());
    for (const VertexId next : chain.subspan(1)) {
        targets.push_back({next, 0});
        while (!targets.empty()) {
            const VertexId from = expanded.back();
            Target& target = targets.back();
            const std::span<const Split> splits = splits_of(from, target.vertex);
            if (!splits.empty() && splits.back().index >= target.since &&
                !is_constrained(from, target.vertex)) {
                target.since = splits.back().index + 1;
                targets.push_back({splits.back().p, target.since});
                continue;
            }
            if (target.vertex != from) expanded.push_back(target.vertex);
            targets.pop_back();
        }
    }
    return expanded;
}

std::vector<std::pair<VertexId, VertexId>> ConstraintHistory::edges_along(
    std::span<const VertexId> chain) const {
    std::vector<std::pair<VertexId, VertexId>> edges;
    std::unordered_set<std::size_t> followed;  // asked for membership alone
    struct Part {
        VertexId a;
        VertexId b;
        std::size_t since;
    };
    std::vector<Part> parts;
    for (std::size_t i = 1; i < chain.size(); ++i) {
        parts.push_back({chain[i - 1], chain[i], 0});
        while (!parts.empty()) {
            const auto [a, b, since] = parts.back();
            parts.pop_back();
            if (is_constrained(a, b)) edges.emplace_back(a, b);
            for (const Split& split : splits_of(a, b)) {
                if (split.index < since || !followed.insert(split.index).second) continue;
                parts.push_back({a, split.p, split.index + 1});
                parts.push_back({split.p, b, split.index + 1});
            }
        }
    }
    return edges;
}

}  // namespace tinsmith::core
