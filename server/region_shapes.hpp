// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "api/formats/gis_geojson.hpp"
#include "core/types/result.hpp"
#include "server/region_partition.hpp"

namespace tinsmith::server {

/// The regions of the ground's polygons as polygons themselves. Errors: the limits.
/// Cost: the regions, one after the other.
core::Result<std::vector<api::RegionShape>> find_shapes(PartitionGround ground,
                                                        const RegionLimits& limits);

/// What finds constraint lines, copied out of a session: it outlives the lock.
struct ConstraintGround {
    struct Drawn {
        std::string id;
        std::vector<core::Chain> chains;
    };
    core::Tin tin;
    std::vector<Drawn> polygons;
};

/// Requires: `all` lie in `tin` as it is.
ConstraintGround constraint_ground(const core::Tin& tin, std::span<const Polygon> all);

/// All constrained edges of the mesh, chained where they meet end to end and the same polygons run
/// along them. Errors: the limits. Cost: the mesh and the chains.
core::Result<std::vector<api::ConstraintLine>> find_constraint_lines(const ConstraintGround& ground,
                                                                     const RegionLimits& limits);

}  // namespace tinsmith::server
