// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/mesh/grid_cell.hpp"
#include "core/types/ids.hpp"

namespace tinsmith::core {

/// One of the cells around a post.
struct CellAround {
    CellCut cut = CellCut::None;
    std::uint32_t first = 0;  ///< slot of its first triangle
};

/// Triangles around a post, each of which shares an edge with the next.
struct Fan {
    Side lowest;          ///< of the sides that start at the post
    TriangleId triangle;  ///< that the mesh gives a vertex which has these triangles (law 3)
};

/// The fans around one post, the one with the lowest side first. Of four cells there are four at
/// most.
struct Fans {
    std::size_t count = 0;
    std::array<Fan, 4> fans;

    const Fan* begin() const { return fans.data(); }
    const Fan* end() const { return fans.data() + count; }
};

/// The fans around the post that is corner i of the i-th of these cells.
Fans fans_around(const std::array<CellAround, 4>& cells);

/// Whether a triangle of the cut has that corner.
bool has_corner(CellCut cut, unsigned corner);

}  // namespace tinsmith::core
