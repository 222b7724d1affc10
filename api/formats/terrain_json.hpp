// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads the JSON body that makes a session:
///
///     {"name"?: text, "crs"?: "EPSG:n", "unit"?: "metre" | "foot" | "US survey foot",
///      "mesh": {"vertices": [[x,y,z],...], "triangles": [[a,b,c],...]}
///      | "points": [[x,y,z],...]
///      | "grid": {"origin": [x,y], "cell": [dx,dy], "columns": n, "rows": m,
///                 "elevations": [z | null, ...]}}
///
/// Points are left for `triangulated` (points_mesh.hpp); their faults point to `/points/17`.
/// What system and unit are worth is for in_its_system to say (terrain_system.hpp).
/// Members may come in any order; unknown and repeated ones are refused by name. Names every
/// fault, not only the first. Whether a mesh's indices exist and its triangles fit together is
/// `core::build_tin`'s to say. Memory: the buffers of the result, no document tree.
Parsed<Terrain> read_terrain_json(std::string_view body, const ReadLimits& limits);

}  // namespace tinsmith::api
