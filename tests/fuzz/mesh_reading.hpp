// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/mesh/repair.hpp"

namespace tinsmith::fuzz {

/// Reads a mesh of any bytes, repairs it and builds it. Whatever they are, faults are few, indices
/// are in range, a mesh that is built keeps its laws, and a second repair finds nothing.
template <typename Read>
int read_mesh(const std::uint8_t* data, std::size_t size, Read read) {
    api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    auto parsed = read({reinterpret_cast<const char*>(data), size}, limits);
    if (!parsed) {
        if (parsed.faults().empty() || parsed.faults().size() > limits.max_faults) std::abort();
        return 0;
    }
    core::MeshData& mesh = parsed->mesh;
    if (mesh.vertices.size() > limits.max_vertices || mesh.triangles.size() > limits.max_triangles)
        std::abort();
    for (const auto& [a, b, c] : mesh.triangles)
        if (std::max({a, b, c}) >= mesh.vertices.size()) std::abort();
    const auto as_it_is = core::build_tin(mesh);
    if (as_it_is && !core::check_tin(*as_it_is).empty()) std::abort();
    const core::Repaired repaired = core::repair_mesh(mesh, size % 2 == 0 ? 0.0 : 0.01);
    const auto mended = core::build_tin(mesh, {repaired.vertices, repaired.triangles});
    if (mended && !core::check_tin(*mended).empty()) std::abort();
    if (!core::repair_mesh(mesh, 0.0).repairs.empty()) std::abort();
    return 0;
}

}  // namespace tinsmith::fuzz
