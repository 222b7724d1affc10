// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/formats/gltf_regions.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/result.hpp"
#include "server/polygon.hpp"
#include "server/regions.hpp"

namespace tinsmith::server {

/// What finds the regions of all polygons, copied out of a session: it outlives the lock.
struct PartitionGround {
    RegionGround regions;
    std::vector<api::RegionFeature> features;  ///< of those with an inside, areas yet to be found
};

/// About what a mesh with regions takes beside the mesh and its encoding, at most: finding them,
/// and what features say of themselves, which is parsed and written again.
std::size_t partition_bytes(const core::Tin& tin, std::span<const Polygon> all);

/// Requires: `all` lie in `tin` as it is.
PartitionGround partition_ground(const core::Tin& tin, std::span<const Polygon> all);

/// The limits of a question that is about all of a mesh and cannot be asked in parts: what can be
/// sent can be looked through some times, and time bounds the rest.
inline RegionLimits limits_for_all(RegionLimits limits, std::size_t triangles) {
    constexpr std::uint64_t kTimes = 16;
    limits.max_visits = std::max<std::uint64_t>(limits.max_visits, kTimes * triangles);
    return limits;
}

/// The triangles by the polygons that contain them. Errors: the limits. Cost: the regions of all
/// polygons, one after the other, and a pass over the mesh.
core::Result<api::RegionPartition> find_partition(PartitionGround ground, std::string unit,
                                                  const RegionLimits& limits);

}  // namespace tinsmith::server
