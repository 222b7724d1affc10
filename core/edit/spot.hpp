// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/mesh/tin.hpp"
#include "core/mesh/walk.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// The surface at one plan position.
struct Spot {
    double elevation = 0.0;  ///< session unit; of a vertex, to the bit
    TriangleId triangle;     ///< a triangle that contains the position, its border included
};

/// The surface at what was located. Requires: it is of this mesh, for p, and not Outside.
Spot spot_of(const Tin& tin, const Location& location, Point2 p);

/// The surface at the position; nothing outside the mesh. On an edge or vertex each triangle there
/// gives the same elevation. Reads only. Cost: that of `locate` from the nearest hint.
std::optional<Spot> spot_at(const Tin& tin, Point2 p);

}  // namespace tinsmith::core
