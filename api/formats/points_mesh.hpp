// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Makes a terrain that is points a mesh, their Delaunay triangulation; any other stays as it is.
/// Vertices are the points in their order but for those that are there already. Requires: the
/// coordinates are those of a plan. Faults that are of a point are placed as the terrain says,
/// others have its pointer. `limits.progress` is told of the second half of the work.
Parsed<Terrain> triangulated(Terrain terrain, const ReadLimits& limits);

}  // namespace tinsmith::api
