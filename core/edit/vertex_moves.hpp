// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/edit/region_edit.hpp"
#include "core/mesh/surgery.hpp"
#include "core/types/error.hpp"

namespace tinsmith::core {

/// A vertex's new elevation.
struct VertexMove {
    VertexId vertex;
    double z = 0.0;
};

/// Moves the vertices up or down, gives each triangle around them a facet of its own, and adds to
/// the report what that was. What is nearer to nothing than a coordinate may be becomes nothing.
/// Requires: each vertex once, in order of slot. Errors, before anything is changed: an elevation
/// out of range; no facet left. Cost: the triangles around, times their logarithm.
std::optional<Error> move_vertices(Surgery& surgery, std::span<const VertexMove> moves,
                                   const IdLimits& ids, EditReport& report);

}  // namespace tinsmith::core
