// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::bench {

/// The terrain, a grid, with about so many triangles on the same ground: elevations in between are
/// bilinear, plus noise of up to `noise` either way. The same every time.
core::MeshData resampled(const core::MeshData& grid, std::size_t triangles, double noise);

/// A made-up shoreline around the middle of the bounds, spanning the given share of them: a rounded
/// rectangle with bays by midpoint displacement on its radius, so that it never meets itself. The
/// same every time.
core::Shape shoreline(const core::Bounds& bounds, double share, std::size_t segments);

}  // namespace tinsmith::bench
