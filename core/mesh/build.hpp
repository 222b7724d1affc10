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
/// triangles overlap one another; and no part that lies over another, nor two elevations at one
/// plan position (see find_overlaps).
/// Keeps the order of vertices and triangles. Where two fans of triangles meet in one vertex only,
/// each further fan gets a copy of the vertex, appended. Constrained edges of the data that are
/// edges of the mesh are marked; others are a fault.
/// Cost: linear, and O(b log b) for b edges of the boundary.
Result<Tin> build_tin(const MeshData& data, const MeshNames& names = {});

}  // namespace tinsmith::core
