// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mesh/grid_build.hpp"
#include "core/mesh/grid_cuts.hpp"
#include "core/mesh/grid_fans.hpp"
#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// Builds in passes over bands of rows, side by side where the executor can.
///
/// Most cells lie among such as have two triangles themselves: there all numbers grow by the same
/// from one cell to the next, and only the diagonals choose among eight patterns.
class GridBuilder {
  public:
    /// Cells of a band: a band is a job of milliseconds.
    static constexpr std::ptrdiff_t kCellsOfBand = std::ptrdiff_t{1} << 18;

    /// Requires: two columns and two rows at least, and an elevation for each post.
    GridBuilder(const PostGrid& grid, std::size_t most_triangles, const Executor& execute,
                std::ptrdiff_t cells_of_band = kCellsOfBand);

    std::optional<Tin> build();

  private:
    /// A fan that does not get the post's own vertex, as another has it.
    struct Copy {
        VertexId named;
        Fan fan;
    };
    /// Rows of cells, with the posts of their first corners; the last band has the last posts, too.
    struct Band {
        std::ptrdiff_t begin = 0;
        std::ptrdiff_t end = 0;
        std::ptrdiff_t end_of_posts = 0;
        bool is_sound = true;       ///< all elevations are such as the core takes
        std::size_t triangles = 0;  ///< of its cells
        std::vector<Side> border;   ///< sides without a twin, in order
        std::vector<Copy> copies;
        GridPlace first_used{PTRDIFF_MAX, PTRDIFF_MAX};  ///< around the posts with a vertex
        GridPlace last_used{-1, -1};
        double low = HUGE_VAL;  ///< and their elevations
        double high = -HUGE_VAL;

        /// The posts from the first to the column `end` of its row have vertices.
        void take(GridPlace first, std::ptrdiff_t end_column) {
            first_used = {std::min(first_used.row, first.row),
                          std::min(first_used.column, first.column)};
            last_used = {std::max(last_used.row, first.row),
                         std::max(last_used.column, end_column - 1)};
        }
        void take(const Band& other) {
            first_used = {std::min(first_used.row, other.first_used.row),
                          std::min(first_used.column, other.first_used.column)};
            last_used = {std::max(last_used.row, other.last_used.row),
                         std::max(last_used.column, other.last_used.column)};
            low = std::min(low, other.low);
            high = std::max(high, other.high);
        }
    };
    using Cell = std::array<Tin::Triangle, 2>;
    using Words = std::array<std::uint64_t, sizeof(Tin::Triangle) / sizeof(std::uint64_t)>;
    using Pattern = std::array<Words, 2>;
    /// Where the hints are that triangles fall into, by the corner that they are without.
    using HintPlaces = std::array<std::uint32_t, 4>;

    void part();
    void for_each_band(void (GridBuilder::*pass)(Band&));
    void cut(Band& band);
    std::size_t number_slots();

    void write(Band& band);
    void write_cells(Band& band, std::ptrdiff_t row);
    void write_inner_cells(GridPlace first, std::ptrdiff_t end);
    void write_cell(Band& band, GridPlace cell);
    Cell triangles_in(GridPlace cell, CellCut cut, const std::array<CellCut, 4>& across) const;
    void write_posts(Band& band, std::ptrdiff_t row);
    void write_inner_posts(Band& band, GridPlace first, std::ptrdiff_t end);
    void write_post(Band& band, GridPlace post);

    void copy_vertices();
    void rename(const Fan& fan, VertexId copy);
    void index();
    void bound();
    void hint();
    void hint(std::size_t begin, std::size_t end);

    /// Whether no post is without data: then numbers follow from places.
    bool is_whole() const { return slots_.empty(); }
    std::size_t post_index(GridPlace post) const {
        return static_cast<std::size_t>(post.row * (columns_ + 1) + post.column);
    }
    std::uint32_t first_slot(GridPlace cell) const {
        const auto index = static_cast<std::size_t>(cell.row * columns_ + cell.column);
        return is_whole() ? static_cast<std::uint32_t>(2 * index) : slots_[index];
    }
    VertexId vertex_of(GridPlace post) const {
        const std::size_t index = post_index(post);
        return {is_whole() ? static_cast<std::uint32_t>(index) : vertices_[index]};
    }

    const PostGrid& grid_;
    const std::size_t most_triangles_;
    const Executor& execute_;
    const std::ptrdiff_t cells_of_band_;
    const GridCompass compass_;
    const std::ptrdiff_t rows_;  ///< of cells
    const std::ptrdiff_t columns_;
    std::vector<double> x_;  ///< of the posts' columns
    std::vector<double> y_;
    GridCuts cuts_;
    std::vector<Band> bands_;
    std::vector<std::uint32_t> slots_;     ///< where posts are missing: first triangles of cells
    std::vector<std::uint32_t> vertices_;  ///< and vertices of posts
    /// Of a post amid cells with two triangles, by which of these fall (a bit each, in the order of
    /// their slots): its vertex's triangle, counted by 2 a cell.
    std::array<std::uint8_t, 16> inner_fans_{};
    std::vector<HintPlaces> hint_columns_;  ///< of each column of cells
    std::vector<HintPlaces> hint_rows_;     ///< of each row of cells: where the row of hints begins
    Tin tin_;
};

}  // namespace tinsmith::core
