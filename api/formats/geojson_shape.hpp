// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/geojson.hpp"
#include "api/formats/geojson_coordinates.hpp"

namespace tinsmith::api {

/// The type of that name; nullopt for every other word.
std::optional<GeometryType> geometry_type(std::string_view name);

/// Makes the shape that `coordinates` mean for a geometry of `type` at `pointer`, or logs every
/// fault of its rings and lines. Empties `coordinates`. Only the members `shape`, `type`,
/// `pointer` and `polygon_starts` of the result are filled.
RequestedShape make_shape(GeometryType type, Coordinates& coordinates, std::string pointer,
                          FaultLog& log);

}  // namespace tinsmith::api
