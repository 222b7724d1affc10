// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/result.hpp"

namespace tinsmith::server {

enum class TerrainFormat { Json, GeoTiff, AsciiGrid, Csv, Glb, Obj, LandXml };

/// By the first bytes: a TIFF, a glTF, XML and an OBJ say so, a grid as text begins with a word of
/// its header, lines of numbers are CSV, anything
/// else is read as JSON.
TerrainFormat terrain_format_of(std::string_view bytes);

/// By a media type, lower-case; nothing where that is no terrain's.
std::optional<TerrainFormat> terrain_format_named(std::string_view media_type);

/// A terrain that was read and its mesh built; `about.mesh` is empty by then.
struct LoadedTerrain {
    api::Terrain about;
    core::Tin tin;
};

/// Asked once a terrain has been read, before its mesh is built, whether there is memory for that:
/// about so many bytes beside what was read, at most.
using MayTake = std::function<bool(std::size_t bytes)>;

/// Reads, mends where that is asked for, and builds in one go, the same for requests, the demo and
/// the command line. Faults of the mesh come back in the body's own places. Where it may not take
/// the memory it stops.
api::Parsed<LoadedTerrain> load_terrain(std::string_view bytes, TerrainFormat format,
                                        const api::TerrainOptions& options,
                                        const api::ReadLimits& limits,
                                        const MayTake& may_take = {});

}  // namespace tinsmith::server
