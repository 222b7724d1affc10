// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::test {

/// A sort of points to triangulate: the same for the same size and seed, on every machine.
/// Positions may repeat, then with the same elevation.
struct PointCloud {
    std::string name;
    std::function<std::vector<core::Point3>(std::size_t size, std::uint64_t seed)> make;
    bool has_ties = false;  ///< four on a circle, or three of the hull on a line
};

/// Scattered, gridded, on circles and lines, clustered, far from the origin, ulps apart.
const std::vector<PointCloud>& point_clouds();
/// Requires: there is such a cloud.
const PointCloud& point_cloud(const std::string& name);

}  // namespace tinsmith::test
