// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "api/fault.hpp"
#include "api/requests.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// The options of a request that brings nothing but a terrain, by name.
std::span<const std::string_view> terrain_option_names();

/// The same where options of polygons stand beside them, whose system `crs` is: the terrain's is
/// `terrain_crs` there.
std::span<const std::string_view> terrain_option_names_beside();

/// What one of them takes, for people; empty: not one of them.
std::string_view terrain_option_values(std::string_view name);

/// Reads how a terrain's bytes are to be taken. `crs` and `terrain_crs` mean the same; what stands
/// beside decides which of them may be given.
Parsed<TerrainOptions> parse_terrain_options(std::span<const NamedOption> options);

}  // namespace tinsmith::api
