// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "api/formats/gltf.hpp"
#include "api/formats/quantization.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// What keeps the mesh from being written with these options, if anything: the first item of it
/// that is wrong, by its number. Draco's encoder is not hardened: what it takes for granted is
/// looked at here. `bounds` as from bounds_of. Cost: one pass over the triangles.
std::optional<EncodeError> find_fault(const core::MeshData& mesh, const Box<double>& bounds,
                                      const GltfOptions& options, const RegionPartition* regions,
                                      const core::Executor& executor);

}  // namespace tinsmith::api
