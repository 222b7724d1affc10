// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// A part of a region that hangs together by edges: its border, each ring's first vertex not
/// repeated at its end.
struct BorderedPart {
    std::vector<VertexId> outer;               ///< counter-clockwise
    std::vector<std::vector<VertexId>> holes;  ///< clockwise
};

/// The borders of a set of triangles, by parts in the order of their first triangles.
///
/// Laws: no ring comes to a place twice, so that each is a simple polygon in plan; rings may touch
/// at vertices. Every side whose triangle is in the set and whose twin is not, or is none, is in
/// one ring, once; but a slit, out and back between two vertices, is no ring. Requires: no triangle
/// is given twice. Cost: the triangles, and a hash search for each vertex of the border.
std::vector<BorderedPart> border_of(const Tin& tin, std::span<const TriangleId> triangles);

}  // namespace tinsmith::core
