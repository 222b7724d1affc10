// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>

#include "api/fault.hpp"
#include "api/formats/grid_mesh.hpp"
#include "api/formats/read_limits.hpp"
#include "api/projection.hpp"

namespace tinsmith::api {

/// The UTM zone around the centre of a grid of degrees, whose elevations are not looked at. `from`
/// is its system, as a code or as WKT.
std::variant<std::string, NoPlace> utm_zone_of(const Grid& grid, const std::string& from);

/// The grid in another system, as `gdalwarp -r bilinear` makes it but without its shortcuts: cells
/// as large as gdalwarp chooses them, elevations between four posts, and no data outside of
/// the old cells, which reach half a cell beyond the outer posts. Elevations keep their unit. Cost:
/// linear; twice the memory of the larger grid.
Parsed<Grid> warp_grid(const Grid& grid, const std::string& from, const std::string& to,
                       const ReadLimits& limits);

}  // namespace tinsmith::api
