// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

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
Result<Tin> build_tin(const MeshData& data);

}  // namespace tinsmith::core
