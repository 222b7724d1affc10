// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads a GeoTIFF of one band of elevations. Each pixel is a post at the pixel's centre; no-data
/// (the band's value, or NaN) is a hole. The band's scale and offset are applied. Elevations
/// that say that they are in another unit than the plan are made ones of its unit; else they are
/// taken to be in it. Degrees are warped where `options.project` says so (raster_warp.hpp).
/// Refused: several bands, rotated rasters, rasters without a georeference, degrees otherwise. No
/// other file and no network is read. The terrain is settled (terrain_system.hpp). May be called
/// from several threads at once.
Parsed<Terrain> read_geotiff(std::string_view bytes, const ReadLimits& limits,
                             const TerrainOptions& options = {});

}  // namespace tinsmith::api
