// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "api/fault.hpp"

namespace tinsmith::api {

/// How much a reader takes in before it stops. Checked before memory is taken, never after.
struct ReadLimits {
    std::size_t max_vertices = 10'000'000;         ///< of a terrain; posts of a grid
    std::size_t max_triangles = 20'000'000;        ///< of a terrain
    std::size_t max_polygon_vertices = 1'000'000;  ///< positions in one polygons request
    std::size_t max_faults = kMaxFaults;           ///< reading stops at this many
    /// Told now and then what share of the bytes has been read; false stops the reading.
    std::function<bool(double)> progress = {};
};

/// What is told when `progress` has stopped a reading.
inline Fault reading_stopped() {
    return {"STOPPED", "The work was stopped while the input was being read.", {}};
}

/// Largest magnitude of x, y and z that a reader accepts, in the terrain's unit. Farther out a
/// double holds less than a tenth of a micrometre and no projected system has its terrain there.
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace tinsmith::api
