// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "core/mesh/tin.hpp"

namespace tinsmith::test {

/// Whether two meshes are one, slot for slot and bit for bit, with all that steers later edits.
inline bool same_tin(const core::Tin& a, const core::Tin& b) {
    if (a.vertex_count() != b.vertex_count() || a.triangle_count() != b.triangle_count())
        return false;
    for (std::uint32_t v = 0; v < a.vertex_count(); ++v) {
        const core::Tin::Vertex& l = a.vertex({v});
        const core::Tin::Vertex& r = b.vertex({v});
        if (std::memcmp(&l.x, &r.x, 3 * sizeof l.x) != 0 || l.triangle != r.triangle) return false;
    }
    for (std::uint32_t t = 0; t < a.triangle_count(); ++t) {
        if (a.triangle({t}) != b.triangle({t})) return false;
    }
    const auto& l = a.constraint_splits();
    const auto& r = b.constraint_splits();
    if (l.size() != r.size()) return false;
    for (std::size_t i = 0; i < l.size(); ++i) {
        if (l[i].a != r[i].a || l[i].b != r[i].b || l[i].p != r[i].p) return false;
    }
    if (a.is_renumbered() != b.is_renumbered() || a.components() != b.components()) return false;
    for (std::uint32_t v = 0; v < a.vertex_count(); ++v) {
        if (a.name({v}) != b.name({v})) return false;
    }
    return a.name_count() == b.name_count() && a.named_split_count() == b.named_split_count() &&
           a.gone_ends().size() == b.gone_ends().size() &&
           a.built_vertex_count() == b.built_vertex_count() && a.next_facet() == b.next_facet() &&
           a.facet_error() == b.facet_error() &&
           std::memcmp(&a.bounds(), &b.bounds(), sizeof a.bounds()) == 0;
}

}  // namespace tinsmith::test
