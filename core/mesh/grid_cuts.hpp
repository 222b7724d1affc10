// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/mesh/grid_cell.hpp"

namespace tinsmith::core {

/// A place in a grid, of a cell or of a post: cell (r, c) has the posts (r, c) to (r + 1, c + 1).
/// Signed: there are cells, of which none is cut, around the grid, too.
struct GridPlace {
    std::ptrdiff_t row = 0;
    std::ptrdiff_t column = 0;
};

/// Where the compass points in a grid that may be stored in any of four ways.
class GridCompass {
  public:
    GridCompass(bool runs_east, bool runs_north) : east_(runs_east), north_(runs_north) {}

    GridPlace post(GridPlace cell, unsigned corner) const {
        const bool is_east = corner == 1 || corner == 2, is_north = corner >= 2;
        return {cell.row + (is_north == north_ ? 1 : 0), cell.column + (is_east == east_ ? 1 : 0)};
    }
    /// The cell of which the post is that corner.
    GridPlace cell_at(GridPlace post, unsigned corner) const {
        const GridPlace step = this->post({}, corner);
        return {post.row - step.row, post.column - step.column};
    }
    GridPlace across(GridPlace cell, unsigned edge) const {
        const int north = north_ ? 1 : -1, east = east_ ? 1 : -1;
        switch (edge) {
            case 0:
                return {cell.row - north, cell.column};
            case 1:
                return {cell.row, cell.column + east};
            case 2:
                return {cell.row + north, cell.column};
            default:
                return {cell.row, cell.column - east};
        }
    }

  private:
    bool east_;   ///< columns run to the east
    bool north_;  ///< rows run to the north
};

/// How each cell of a grid is cut; those around it, which are not, are asked for like the others.
class GridCuts {
  public:
    GridCuts(std::ptrdiff_t rows, std::ptrdiff_t columns)
        : width_(columns + 2),
          cuts_(static_cast<std::size_t>((rows + 2) * (columns + 2)), CellCut::None) {}

    CellCut operator[](GridPlace cell) const { return row(cell.row)[cell.column]; }
    /// From the row's first cell on: there is one before it, and one behind the last.
    const CellCut* row(std::ptrdiff_t row) const { return cuts_.data() + (row + 1) * width_ + 1; }
    CellCut* row(std::ptrdiff_t row) { return cuts_.data() + (row + 1) * width_ + 1; }

  private:
    std::ptrdiff_t width_;
    std::vector<CellCut> cuts_;
};

}  // namespace tinsmith::core
