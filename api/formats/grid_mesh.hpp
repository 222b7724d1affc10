// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/post_grid.hpp"

namespace tinsmith::api {

using Grid = core::PostGrid;

/// Triangulates a grid: two triangles in a cell whose four posts have data, one where exactly
/// three have, none otherwise. The diagonal joins the two opposite posts that differ less in
/// elevation; on a tie it runs from south-west to north-east. So a slope's ridges and channels are
/// followed and a flat grid looks regular.
///
/// The mesh's vertices are the posts in the grid's order without those that no triangle uses; its
/// triangles are ordered cell by cell and counter-clockwise whatever the signs of dx and dy.
/// Requires: elevations.size() == columns * rows; every elevation is NaN or within kMaxCoordinate.
/// Faults point below `pointer`, the grid's own place in the body.
Parsed<core::MeshData> mesh_of_grid(const Grid& grid, const ReadLimits& limits,
                                    const std::string& pointer = "");

/// Makes a terrain that is a grid the mesh of it; any other stays as it is.
Parsed<Terrain> meshed(Parsed<Terrain> terrain, const ReadLimits& limits);

/// The mesh that `core::build_tin` makes of those triangles, bit for bit, the short way
/// (core/mesh/grid_build.hpp). Nothing where either refuses the grid, and where the short way does
/// not lead there: the long one says what is wrong.
/// Requires: elevations.size() == columns * rows.
std::optional<core::Tin> tin_of_grid(const Grid& grid, const ReadLimits& limits,
                                     const core::Executor& execute = core::one_after_another);

}  // namespace tinsmith::api
