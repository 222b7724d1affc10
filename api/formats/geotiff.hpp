// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads a GeoTIFF of one band of elevations. Each pixel is a post at the pixel's centre; no-data
/// (the band's value, or NaN) is a hole. The band's scale and offset are applied. The elevations
/// are taken to be in the unit of the plan coordinates. Refused: several bands, geographic
/// (degrees) and rotated rasters, rasters without a georeference. No other file and no network is
/// read. May be called from several threads at once.
Parsed<Terrain> read_geotiff(std::string_view bytes, const ReadLimits& limits);

}  // namespace tinsmith::api
