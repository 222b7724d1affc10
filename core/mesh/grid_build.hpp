// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "core/mesh/tin.hpp"
#include "core/types/executor.hpp"
#include "core/types/post_grid.hpp"

namespace tinsmith::core {

/// The mesh that `build_tin` makes of a grid's triangles, bit for bit, without them: vertices are
/// the posts in the grid's order without those that no triangle uses, triangles those of the cells
/// (grid_cell.hpp) in the cells' order, each from its lowest corner on. The grid's shape proves
/// what `build_tin` has to look for: columns and rows that are apart in doubles make every triangle
/// counter-clockwise and let none lie over another; neighbours are found by their place.
///
/// Nothing where there is no such mesh (no triangle, or more than `most_triangles`), where
/// `build_tin` would find a fault, and where the shape proves nothing, as posts fall together: then
/// `build_tin` says what is wrong.
/// The executor is given parts of the grid; the result does not depend on how many it does at once.
/// Cost: linear; beside the mesh a byte a cell, where posts are missing 8 bytes a cell more.
std::optional<Tin> build_tin_of_grid(const PostGrid& grid, std::size_t most_triangles,
                                     const Executor& execute = one_after_another);

}  // namespace tinsmith::core
