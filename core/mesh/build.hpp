// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// What the caller calls the vertices and triangles of the data, where that is not their index: the
/// places of faults are told by these.
struct MeshNames {
    std::span<const std::uint32_t> vertices{};
    std::span<const std::uint32_t> triangles{};
};

/// Makes a TIN of plain buffers, or names every fault it finds, at most kMaxFaults, with its
/// index in the buffers.
/// Requires of the data, and refuses otherwise: finite coordinates in range; triangles strictly
/// counter-clockwise in plan; edges of at most two triangles; no unused vertex; no vertex whose
/// triangles overlap one another.
/// Keeps the order of vertices and triangles. Where two fans of triangles meet in one vertex only,
/// each further fan gets a copy of the vertex, appended. Constrained edges of the data that are
/// edges of the mesh are marked; others are a fault.
/// Not promised: parts of the mesh that overlap without sharing a vertex are not looked for.
/// Cost: linear.
Result<Tin> build_tin(const MeshData& data, const MeshNames& names = {});

}  // namespace tinsmith::core
