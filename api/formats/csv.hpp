// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads points x, y, z, a line each, and leaves them for `triangulated` (points_mesh.hpp). Fields
/// are parted by commas, semicolons, tabs or blanks, whichever the first line of data has. A first
/// line that does not begin with a number is a header; by its names columns may come in any order,
/// and those that are none of x, y and z are passed over; longitude and latitude are x and y where
/// the options name a geographic system and one to project to. Without one there are three fields,
/// x, y, z. Lines that begin with # and empty ones are passed over. Numbers have a decimal point; a
/// decimal comma is a fault. UTF-8, with or without its mark; lines end with LF, CR LF or CR. Names
/// every fault, up to the limit, with its line and column; `index` is the point's number from 0.
/// Memory: the points and the result.
Parsed<Terrain> read_csv(std::string_view bytes, const TerrainOptions& options,
                         const ReadLimits& limits);

/// Whether bytes that say nothing else of themselves look like such lines: the first one that is
/// not passed over is three numbers, or a header that names x, y and z, or degrees.
bool looks_like_csv(std::string_view bytes);

}  // namespace tinsmith::api
