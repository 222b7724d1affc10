// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <variant>

#include "api/fault.hpp"
#include "api/formats/gltf_regions.hpp"
#include "api/requests.hpp"
#include "core/types/error.hpp"
#include "core/types/mesh_data.hpp"
#include "server/region_partition.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

/// What a writer is given: the part of a mesh that was asked for.
struct MeshSource {
    core::MeshData mesh;
    std::optional<api::RegionPartition> regions;  ///< where they were asked for
};

/// A mesh at a version with what finds its regions, if they are asked for. It outlives the lock.
struct MeshGround {
    core::MeshData mesh;
    std::uint64_t version = 0;
    std::optional<PartitionGround> regions;
};

/// As it is now. Takes the readers' lock for the time of a copy.
MeshGround ground_now(const Session& session, bool regions);

/// Of a version made again.
MeshGround ground_of(const SessionState& state, std::uint64_t version, bool regions);

/// Why there is no such part: the limits, or a box that meets nothing.
using NoSource = std::variant<core::Errors, api::Fault>;

/// The regions and the box asked for. Holds no lock.
std::variant<MeshSource, NoSource> source_of(MeshGround ground, const api::MeshOptions& options,
                                             const std::string& unit, RegionLimits limits);

}  // namespace tinsmith::server
