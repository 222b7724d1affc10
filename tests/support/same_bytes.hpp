// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

/// Whether two meshes are one, bit for bit.
inline bool same_bytes(const core::MeshData& a, const core::MeshData& b) {
    const auto same = [](const auto& l, const auto& r) {
        return l.size() == r.size() &&
               (l.empty() || std::memcmp(l.data(), r.data(), l.size() * sizeof l[0]) == 0);
    };
    return same(a.vertices, b.vertices) && same(a.triangles, b.triangles) &&
           same(a.constraints, b.constraints);
}

}  // namespace tinsmith::test
