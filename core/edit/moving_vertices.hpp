// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/ids.hpp"

namespace tinsmith::core {

/// The part of the mesh that an edit may move.
struct Extent {
    std::span<const TriangleId> outer;  ///< beyond these nothing moves, where there is a limit
    std::span<const TriangleId> full;   ///< of these, those that move in full; in order, likewise
    /// Where the outer part ends nothing moves either; else its border does, in full.
    bool is_limited = true;
    std::span<const Chain> limit = {};  ///< the lines at which it ends, on the mesh's boundary too
    /// Between full and outer: what distance counts from, and where it stops to.
    const Shape* lines = nullptr;
    double width = 0.0;
};

/// A vertex that moves, with its share of the change: above 0, and 1 where it moves in full.
struct Moving {
    VertexId vertex;
    double share = 1.0;
    VertexId leader;  ///< the lowest of the vertices at its position, which move as one
};

/// In order of slot. Cost: linear in the mesh, and in the outer part times the logarithm of the
/// lines.
std::vector<Moving> moving_vertices(const Tin& tin, const Extent& extent);

}  // namespace tinsmith::core
