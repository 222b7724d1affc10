// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"

namespace tinsmith::api {

/// What is wrong with the shapes' elevations if the surface is to take them, at most `most` faults:
/// positions without one or with one that is no length, rings that end at another elevation than
/// they began, and two elevations in one place. No fault: each path has one elevation for each
/// point. Cost: linear.
Faults elevation_faults(std::span<const RequestedShape> shapes, std::size_t most);

/// Makes the shapes what they would be had they been drawn in plan: to be draped.
void drop_elevations(std::span<RequestedShape> shapes);

}  // namespace tinsmith::api
