// SPDX-License-Identifier: Apache-2.0
#include "core/regions/coverage.hpp"

#include <algorithm>

namespace tinsmith::core {

template <typename Key>
ShapesByKey<Key>::ShapesByKey(std::vector<std::pair<Key, std::size_t>> entries) {
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    keys_.reserve(entries.size());
    shapes_.reserve(entries.size());
    for (const auto& [key, shape] : entries) {
        keys_.push_back(key);
        shapes_.push_back(shape);
    }
}

template <typename Key>
std::span<const std::size_t> ShapesByKey<Key>::of(Key key) const {
    const auto [first, last] = std::equal_range(keys_.begin(), keys_.end(), key);
    return std::span(shapes_).subspan(static_cast<std::size_t>(first - keys_.begin()),
                                      static_cast<std::size_t>(last - first));
}

template class ShapesByKey<std::uint64_t>;
template class ShapesByKey<TriangleId>;

Linework::Linework(const ConstraintHistory& history, std::span<const Lines> lines) {
    std::vector<std::pair<std::uint64_t, std::size_t>> entries;
    for (const auto& [shape, chains] : lines) {
        for (const Chain& chain : chains)
            for (const auto& [a, b] : history.edges_along(chain.vertices))
                entries.emplace_back(edge_key(a, b), shape);
    }
    shapes_ = ShapesByKey<std::uint64_t>(std::move(entries));
}

std::span<const std::size_t> Linework::along(VertexId a, VertexId b) const {
    return shapes_.of(edge_key(a, b));
}

std::span<const std::size_t> Linework::along(const Tin& tin, Side side) const {
    return along(tin.origin(side), tin.destination(side));
}

Coverage::Coverage(std::span<const Area> areas) {
    std::vector<std::pair<TriangleId, std::size_t>> entries;
    for (const auto& [shape, region] : areas)
        for (const TriangleId t : region->triangles)
            entries.emplace_back(t, shape);
    shapes_ = ShapesByKey<TriangleId>(std::move(entries));
}

}  // namespace tinsmith::core
