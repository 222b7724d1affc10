// SPDX-License-Identifier: Apache-2.0
#include "core/regions/constraint_history.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_set>

#include "core/mesh/walk.hpp"

namespace tinsmith::core {

ConstraintHistory::ConstraintHistory(const Tin& tin) : tin_(tin), gone_ends_(tin.gone_ends()) {
    const std::vector<ConstraintSplit>& splits = tin.constraint_splits();
    splits_.reserve(splits.size());
    for (std::size_t i = 0; i < splits.size(); ++i) {
        const auto [a, b, p] = splits[i];
        if (i < tin.named_split_count())
            splits_.push_back({edge_key(a, b), i, p});
        else
            splits_.push_back({edge_key(tin.name(a), tin.name(b)), i, tin.name(p)});
    }
    std::sort(splits_.begin(), splits_.end(), [](const Split& l, const Split& r) {
        return std::tie(l.edge, l.index) < std::tie(r.edge, r.index);
    });
    if (!tin.is_renumbered()) return;
    slots_.reserve(tin.vertex_count());
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        slots_.emplace_back(tin.name({v}), VertexId{v});
    std::sort(slots_.begin(), slots_.end());
    std::ranges::sort(gone_ends_, {}, &GoneEnd::name);
}

std::optional<Point2> ConstraintHistory::plan_of(VertexId name) const {
    std::optional<Point2> plan;
    for_each_slot(name, [&](VertexId slot) { plan = tin_.plan(slot); });
    if (plan) return plan;
    const auto gone = std::ranges::lower_bound(gone_ends_, name, {}, &GoneEnd::name);
    if (gone != gone_ends_.end() && gone->name == name) plan = gone->plan;
    return plan;
}

/// Where two vertices were parted, one pair at most of their slots is joined: an edge that stays
/// stays one.
ConstraintHistory::Edge ConstraintHistory::edge_between(VertexId a, VertexId b) const {
    Edge found;
    for_each_slot(a, [&](VertexId v) {
        for_each_slot(b, [&](VertexId w) {
            if (found.side.valid()) return;
            found.side = find_edge(tin_, v, w);
            found.origin_is_first = found.side.valid() && tin_.origin(found.side) == v;
        });
    });
    return found;
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
    const Side edge = edge_between(a, b).side;
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

std::vector<std::vector<VertexId>> ConstraintHistory::lines_along(
    std::span<const VertexId> chain) const {
    std::vector<std::vector<VertexId>> lines;
    const std::vector<VertexId> names = expand(chain);
    if (names.size() == 1) {
        for_each_slot(names.front(), [&lines](VertexId slot) {
            if (lines.empty()) lines.push_back({slot});
        });
        return lines;
    }
    bool goes_on = false;
    for (std::size_t i = 1; i < names.size(); ++i) {
        const auto [side, origin_is_first] = edge_between(names[i - 1], names[i]);
        if (!side.valid()) {
            goes_on = false;
            continue;
        }
        const VertexId from = origin_is_first ? tin_.origin(side) : tin_.destination(side);
        const VertexId to = origin_is_first ? tin_.destination(side) : tin_.origin(side);
        if (!goes_on || lines.back().back() != from) lines.push_back({from});
        lines.back().push_back(to);
        goes_on = true;
    }
    return lines;
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
            const auto [edge, origin_is_first] = edge_between(a, b);
            if (edge.valid() && tin_.is_constrained(edge)) {
                const VertexId v = tin_.origin(edge), w = tin_.destination(edge);
                edges.push_back(origin_is_first ? std::pair{v, w} : std::pair{w, v});
            }
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
