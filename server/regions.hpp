// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "api/regions.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/result.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// What finds regions, copied out of a session: it outlives the lock.
struct RegionGround {
    struct Drawn {
        std::string id;
        bool has_inside = true;
        bool is_wanted = false;
        core::Winding winding = core::Winding::EvenOdd;
        core::Shape shape;
        core::ShapeReport report;  ///< its chains, and its parts outside the mesh
    };
    core::Tin tin;
    std::vector<Drawn> polygons;  ///< those wanted and all whose boxes touch theirs, in order
};

/// About what finding regions takes beside the copy of the mesh and its answer, at most.
std::size_t region_bytes(const core::Tin& tin, std::span<const Polygon> all);

/// Requires: `all` lie in `tin` as it is; `wanted` are indices of polygons with an inside, growing.
RegionGround region_ground(const core::Tin& tin, std::span<const Polygon> all,
                           std::span<const std::size_t> wanted);

/// What finding regions may cost.
struct RegionLimits {
    /// Triangles and edges looked at, of all polygons together; an id in the answer counts as some.
    std::uint64_t max_visits = UINT64_MAX;
    std::function<bool()> cancelled = {};
};

/// The regions of the polygons wanted, with what the others have to do with their triangles and
/// edges. Errors: the limits.
/// Cost: the regions and chains of all polygons of the ground, one after the other. Memory: four
/// bytes for each triangle of the mesh, some words for each edge along a polygon, and the answer.
core::Result<std::vector<api::RegionView>> find_regions(const RegionGround& ground,
                                                        const RegionLimits& limits);

}  // namespace tinsmith::server
