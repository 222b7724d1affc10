// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// Makes a TIN of plain buffers, or names every fault (at most kMaxFaults) with its index.
/// Triangles may come in either orientation; all are kept counter-clockwise in plan.
Result<Tin> build_tin(const MeshData& data);

}  // namespace tinsmith::core
