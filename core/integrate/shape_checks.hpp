// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// What is wrong with the shapes by themselves, whatever the mesh: coordinates and elevations that
/// are not finite or out of range, elevations that are missing, one position with two elevations
/// in a row. Empty: nothing. Cost: linear.
Errors check_shapes(std::span<const Shape> shapes);

/// Whether any of the mesh lies inside the shapes. Requires: no path meets the mesh, so that each
/// component is inside or outside as a whole. Cost: components times points.
bool encloses_mesh(const Tin& tin, std::span<const Shape> shapes);

/// Says that nothing of the request meets the mesh, and where both are.
Error outside_error(const Tin& tin, std::span<const Shape> shapes);

/// Names each part that lies outside the mesh.
Errors leaving_errors(const Report& report);

}  // namespace tinsmith::core
