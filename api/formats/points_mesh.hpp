// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// Says in a fault where the point of its index was read, and the earlier one that it contradicts,
/// in the format's own way.
using PlacePoint =
    std::function<void(Fault& fault, std::size_t point, std::optional<std::size_t> earlier)>;

/// The Delaunay triangulation of a terrain's points: vertices are the points in their order but
/// for those that are there already. Faults that are of a point are placed by `place`, others
/// point to `pointer`. `limits.progress` is told of the second half of the work.
Parsed<core::MeshData> mesh_of_points(std::span<const core::Point3> points,
                                      const ReadLimits& limits, const std::string& pointer,
                                      const PlacePoint& place);

}  // namespace tinsmith::api
