// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// A regular grid of elevations, row by row. The post in column c of row r lies at
/// (origin.x + c * dx, origin.y + r * dy); dx and dy may be negative.
struct Grid {
    core::Point2 origin;  ///< where the first elevation is
    double dx = 1.0;
    double dy = 1.0;
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<double> elevations;  ///< columns * rows; NaN: no data
};

/// Triangulates a grid: two triangles in a cell whose four posts have data, one where exactly
/// three have, none otherwise. The diagonal joins the two opposite posts that differ less in
/// elevation; on a tie it runs from south-west to north-east. So a slope's ridges and channels are
/// followed and a flat grid looks regular.
///
/// The mesh's vertices are the posts in the grid's order without those that no triangle uses; its
/// triangles are ordered cell by cell and counter-clockwise whatever the signs of dx and dy.
/// Requires: elevations.size() == columns * rows; every elevation is NaN or within kMaxCoordinate.
/// Faults point below `pointer`, the grid's own place in the body.
Parsed<core::MeshData> mesh_of_grid(const Grid& grid, const ReadLimits& limits,
                                    const std::string& pointer = "");

}  // namespace tinsmith::api
