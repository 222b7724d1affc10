// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Whether the bytes begin with a word of an ESRI ASCII grid's header.
bool begins_as_ascii_grid(std::string_view bytes);

/// Reads an ESRI ASCII grid of elevations:
///
///     ncols 4                  words in any case and order, each once
///     nrows 3
///     xllcorner 500000         or xllcenter; likewise yllcorner, yllcenter
///     yllcorner 4000000
///     cellsize 30              or dx and dy
///     NODATA_value -9999       may be missing; "nan" is no data in any case
///     1 2 3 4 ...              rows from north to south, broken into lines anyhow
///
/// Each cell is a post at its centre. The format names no system: `options.crs` does, or nobody.
/// Degrees are warped where `options.project` says so (raster_warp.hpp). The terrain is settled
/// (terrain_system.hpp). Values are read as doubles, to the last digit. Faults name line and
/// column.
Parsed<Terrain> read_ascii_grid(std::string_view bytes, const TerrainOptions& options,
                                const ReadLimits& limits);

}  // namespace tinsmith::api
