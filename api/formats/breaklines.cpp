// SPDX-License-Identifier: Apache-2.0
#include "api/formats/breaklines.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace tinsmith::api {

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

auto as_tuple(const core::Point3& p) {
    return std::tuple(p.x, p.y, p.z);
}

std::array<std::uint32_t, 2> edge_of(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

}  // namespace

bool Breaklines::take(std::span<const core::Point3> line) {
    if (line.size() < 2) return false;
    if (edges_.empty()) make_tables();
    of_a_line_.clear();
    std::uint32_t last = vertex_at(line.front());
    for (const core::Point3& position : line.subspan(1)) {
        const std::uint32_t next = vertex_at(position);
        if (last == kNone || next == kNone || !has_edge(last, next)) return false;
        of_a_line_.push_back({last, next});
        last = next;
    }
    mesh_.constraints.insert(mesh_.constraints.end(), of_a_line_.begin(), of_a_line_.end());
    return true;
}

void Breaklines::make_tables() {
    by_position_.resize(mesh_.vertices.size());
    std::iota(by_position_.begin(), by_position_.end(), std::uint32_t{0});
    std::sort(by_position_.begin(), by_position_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return as_tuple(mesh_.vertices[a]) < as_tuple(mesh_.vertices[b]);
    });
    edges_.reserve(3 * mesh_.triangles.size());
    for (const auto& [a, b, c] : mesh_.triangles)
        for (const auto& edge : {edge_of(a, b), edge_of(b, c), edge_of(c, a)})
            edges_.push_back(edge);
    std::sort(edges_.begin(), edges_.end());
}

std::uint32_t Breaklines::vertex_at(const core::Point3& position) const {
    const auto found = std::lower_bound(by_position_.begin(), by_position_.end(), position,
                                        [this](std::uint32_t v, const core::Point3& p) {
                                            return as_tuple(mesh_.vertices[v]) < as_tuple(p);
                                        });
    return found != by_position_.end() && mesh_.vertices[*found] == position ? *found : kNone;
}

bool Breaklines::has_edge(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(edges_.begin(), edges_.end(), edge_of(a, b));
}

}  // namespace tinsmith::api
