// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A regular grid of elevations, row by row. The post in column c of row r lies at
/// (origin.x + c * dx, origin.y + r * dy); dx and dy may be negative.
struct PostGrid {
    Point2 origin;  ///< where the first elevation is
    double dx = 1.0;
    double dy = 1.0;
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<double> elevations;  ///< columns * rows; NaN: no data

    double x(std::size_t column) const { return origin.x + static_cast<double>(column) * dx; }
    double y(std::size_t row) const { return origin.y + static_cast<double>(row) * dy; }
};

}  // namespace tinsmith::core
