// SPDX-License-Identifier: Apache-2.0
// A grid's triangles and vertices, written to their slots.
#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "core/mesh/grid_builder.hpp"

namespace tinsmith::core {

namespace {

/// The side of the triangle without a corner that lies in the cell.
constexpr std::array<unsigned, 4> kInnerSide{2, 0, 1, 2};

constexpr unsigned kNoSide = 8;

/// Which side of which of its triangles a cell has on each edge: 4 * triangle + side, or none.
constexpr auto kOnEdge = [] {
    std::array<std::array<unsigned, 4>, kCellCuts> table{};
    for (std::size_t cut = 0; cut < kCellCuts; ++cut) {
        table[cut] = {kNoSide, kNoSide, kNoSide, kNoSide};
        for (unsigned local = 0; local < kCutTriangles[cut].count; ++local) {
            const unsigned without = kCutTriangles[cut].without[local];
            for (unsigned i = 0; i < 3; ++i)
                if (i != kInnerSide[without])
                    table[cut][kTriangleWithout[without][i]] = 4 * local + i;
        }
    }
    return table;
}();

/// Runs of inner cells that are shorter are not worth their patterns.
constexpr std::ptrdiff_t kShortRun = 16;

/// 0 or 1, as `falls` does: these are put together by bits, without a branch for each.
unsigned has_two(CellCut cut) {
    return cut >= CellCut::Rising ? 1 : 0;
}

unsigned falls(CellCut cut) {
    return cut == CellCut::Falling ? 1 : 0;
}

}  // namespace

void GridBuilder::write(Band& band) {
    for (std::ptrdiff_t row = band.begin; row < band.end_of_posts; ++row) {
        write_posts(band, row);
        if (row < band.end) write_cells(band, row);
    }
}

/// Inner cells have two triangles, as have all that share an edge with them.
void GridBuilder::write_cells(Band& band, std::ptrdiff_t row) {
    const CellCut *before = cuts_.row(row - 1), *cuts = cuts_.row(row), *after = cuts_.row(row + 1);
    const auto is_inner = [=](std::ptrdiff_t c) {
        return (has_two(cuts[c - 1]) & has_two(cuts[c]) & has_two(cuts[c + 1]) &
                has_two(before[c]) & has_two(after[c])) != 0;
    };
    for (std::ptrdiff_t c = 0; c < columns_;) {
        std::ptrdiff_t end = c;
        while (end < columns_ && is_inner(end))
            ++end;
        if (end - c >= kShortRun) write_inner_cells({row, std::exchange(c, end)}, end);
        for (end = std::min(end + 1, columns_); c < end; ++c)
            write_cell(band, {row, c});
    }
}

void GridBuilder::write_inner_cells(GridPlace first, std::ptrdiff_t end) {
    const auto [row, column] = first;
    std::array<Pattern, 8> patterns{};
    for (unsigned i = 0; i < patterns.size(); ++i) {
        const auto cut_by = [i](unsigned bit) {
            return (i >> bit & 1U) != 0 ? CellCut::Falling : CellCut::Rising;
        };
        // North and south it does not matter which.
        std::array<CellCut, 4> across{};
        across.fill(CellCut::Rising);
        for (const unsigned edge : {1U, 3U})
            across[edge] = cut_by(compass_.across(first, edge).column < column ? 0 : 2);
        patterns[i] = std::bit_cast<Pattern>(triangles_in(first, cut_by(1), across));
    }
    // From cell to cell: a vertex, and two triangles of four sides each, further on. No number ever
    // grows out of its half. Word by word: what was written in halves cannot be read as a whole at
    // once.
    Tin::Triangle step{{VertexId{1}, VertexId{1}, VertexId{1}}, {}, {2}, 0};
    step.twins.fill(Side({2}, 0));
    const auto steps = std::bit_cast<Words>(step);
    Words gone{};
    const CellCut* const cuts = cuts_.row(row);
    auto* to = reinterpret_cast<std::byte*>(&tin_.triangles_[first_slot(first)]);
    unsigned choice = falls(cuts[column - 1]) << 1 | falls(cuts[column]) << 2;
    for (std::ptrdiff_t c = column; c < end; ++c) {
        choice = choice >> 1 | falls(cuts[c + 1]) << 2;
        for (const Words& triangle : patterns[choice]) {
            for (std::size_t i = 0; i < gone.size(); ++i) {
                const std::uint64_t word = triangle[i] + gone[i];
                std::memcpy(to, &word, sizeof word);
                to += sizeof word;
            }
        }
        for (std::size_t i = 0; i < gone.size(); ++i)
            gone[i] += steps[i];
    }
}

void GridBuilder::write_cell(Band& band, GridPlace cell) {
    const CellCut cut = cuts_[cell];
    const unsigned count = triangles_of(cut).count;
    if (count == 0) return;
    std::array<CellCut, 4> across{};
    for (unsigned edge = 0; edge < 4; ++edge)
        across[edge] = cuts_[compass_.across(cell, edge)];
    const Cell triangles = triangles_in(cell, cut, across);
    const std::uint32_t slot = first_slot(cell);
    for (std::uint32_t local = 0; local < count; ++local) {
        tin_.triangles_[slot + local] = triangles[local];
        for (unsigned i = 0; i < 3; ++i)
            if (!triangles[local].twins[i].valid()) band.border.push_back({{slot + local}, i});
    }
}

/// The triangles of a cell that is cut so, among cells that are cut so. Each side along an edge has
/// its twin across, the one side within has it in the cell's other triangle.
GridBuilder::Cell GridBuilder::triangles_in(GridPlace cell, CellCut cut,
                                            const std::array<CellCut, 4>& across) const {
    Cell made;
    const CutTriangles& triangles = triangles_of(cut);
    const std::uint32_t slot = first_slot(cell);
    for (unsigned local = 0; local < triangles.count; ++local) {
        const unsigned without = triangles.without[local];
        Tin::Triangle& triangle = made[local];
        triangle.facet = {slot + local};
        for (unsigned i = 0; i < 3; ++i) {
            const unsigned corner = kTriangleWithout[without][i];
            triangle.vertices[i] = vertex_of(compass_.post(cell, corner));
            if (i == kInnerSide[without]) {
                const unsigned other = triangles.without[1 - local];
                if (triangles.count == 2)
                    triangle.twins[i] = Side({slot + 1 - local}, kInnerSide[other]);
                continue;
            }
            const unsigned found =
                kOnEdge[static_cast<std::size_t>(across[corner])][(corner + 2) % 4];
            if (found == kNoSide) continue;
            triangle.twins[i] =
                Side({first_slot(compass_.across(cell, corner)) + found / 4}, found % 4);
        }
    }
    return made;
}

/// Inner posts have four cells with two triangles each around them.
void GridBuilder::write_posts(Band& band, std::ptrdiff_t row) {
    const CellCut *before = cuts_.row(row - 1), *after = cuts_.row(row);
    const auto is_inner = [=](std::ptrdiff_t c) {
        return (has_two(before[c - 1]) & has_two(before[c]) & has_two(after[c - 1]) &
                has_two(after[c])) != 0;
    };
    for (std::ptrdiff_t c = 0; c <= columns_;) {
        std::ptrdiff_t end = c;
        while (end <= columns_ && is_inner(end))
            ++end;
        if (end > c) write_inner_posts(band, {row, std::exchange(c, end)}, end);
        if (c <= columns_) write_post(band, {row, c++});
    }
}

void GridBuilder::write_inner_posts(Band& band, GridPlace first, std::ptrdiff_t end) {
    const auto [row, column] = first;
    band.take(first, end);
    std::array<std::uint32_t, 16> triangles{};
    const std::array<std::uint32_t, 2> slots{first_slot({row - 1, column - 1}),
                                             first_slot({row, column - 1})};
    for (unsigned falling = 0; falling < 16; ++falling)
        triangles[falling] = slots[inner_fans_[falling] / 4] + inner_fans_[falling] % 4;

    const CellCut *before = cuts_.row(row - 1), *after = cuts_.row(row);
    const double* const elevations = &grid_.elevations[post_index({row, 0})];
    const double y = y_[static_cast<std::size_t>(row)];
    Tin::Vertex* to = &tin_.vertices_[vertex_of(first).index()];
    double low = band.low, high = band.high;
    std::uint32_t gone = 0;
    unsigned falling = falls(before[column - 1]) << 1 | falls(after[column - 1]) << 3;
    for (std::ptrdiff_t c = column; c < end; ++c, ++to, gone += 2) {
        falling = (falling >> 1 & 5U) | falls(before[c]) << 1 | falls(after[c]) << 3;
        const double z = elevations[c];
        *to = {x_[static_cast<std::size_t>(c)], y, z, {triangles[falling] + gone}};
        low = z < low ? z : low;  // as std::min has it: the first of equal ones stays
        high = z > high ? z : high;
    }
    band.low = low;
    band.high = high;
}

void GridBuilder::write_post(Band& band, GridPlace post) {
    std::array<CellAround, 4> around;
    for (unsigned corner = 0; corner < 4; ++corner) {
        const GridPlace cell = compass_.cell_at(post, corner);
        const CellCut cut = cuts_[cell];
        if (cut != CellCut::None) around[corner] = {cut, first_slot(cell)};
    }
    const Fans fans = fans_around(around);
    if (fans.count == 0) return;
    band.take(post, post.column + 1);
    const VertexId named = vertex_of(post);
    const double z = grid_.elevations[post_index(post)];
    band.low = std::min(band.low, z);
    band.high = std::max(band.high, z);
    tin_.vertices_[named.index()] = {x_[static_cast<std::size_t>(post.column)],
                                     y_[static_cast<std::size_t>(post.row)], z,
                                     fans.begin()->triangle};
    for (const Fan* fan = fans.begin() + 1; fan != fans.end(); ++fan)
        band.copies.push_back({named, *fan});
}

}  // namespace tinsmith::core
