// SPDX-License-Identifier: Apache-2.0
#include "core/regions/constraint_history.hpp"

#include <algorithm>
#include <tuple>

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

const ConstraintHistory::Split* ConstraintHistory::newest_split(VertexId a, VertexId b) const {
    const std::uint64_t edge = edge_key(a, b);
    const auto after =
        std::upper_bound(splits_.begin(), splits_.end(), edge,
                         [](std::uint64_t key, const Split& split) { return key < split.edge; });
    if (after == splits_.begin() || std::prev(after)->edge != edge) return nullptr;
    return &*std::prev(after);
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
            const Side edge = find_edge(tin_, from, target.vertex);
            const Split* split = edge.valid() && tin_.is_constrained(edge)
                                     ? nullptr
                                     : newest_split(from, target.vertex);
            if (split != nullptr && split->index >= target.since) {
                target.since = split->index + 1;
                targets.push_back({split->p, target.since});
                continue;
            }
            if (target.vertex != from) expanded.push_back(target.vertex);
            targets.pop_back();
        }
    }
    return expanded;
}

}  // namespace tinsmith::core
