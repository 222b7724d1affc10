// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/grid_fans.hpp"

#include <algorithm>
#include <utility>

namespace tinsmith::core {

namespace {

/// Which triangles of a cut have a corner, counter-clockwise around it: from the edge that begins
/// there to the edge that ends there. Two share the diagonal.
struct AtCorner {
    std::size_t count = 0;
    struct Corner {
        unsigned local = 0;  ///< of the cell's triangles
        unsigned index = 0;  ///< of the triangle's corners
    };
    std::array<Corner, 2> corners{};
    bool has_first_edge = false;
    bool has_last_edge = false;
};

constexpr AtCorner triangles_at(CellCut cut, unsigned corner) {
    AtCorner at;
    const CutTriangles& triangles = triangles_of(cut);
    for (unsigned local = 0; local < triangles.count; ++local) {
        const auto& corners = kTriangleWithout[triangles.without[local]];
        for (unsigned i = 0; i < 3; ++i) {
            if (corners[i] != corner) continue;
            const bool is_first = corners[Side::next_of(i)] == (corner + 1) % 4;
            if (is_first) at.corners[1] = at.corners[0];
            at.corners[is_first ? 0 : at.count] = {local, i};
            ++at.count;
            at.has_first_edge |= is_first;
            at.has_last_edge |= corners[Side::previous_of(i)] == (corner + 3) % 4;
        }
    }
    return at;
}

constexpr auto kAtCorner = [] {
    std::array<std::array<AtCorner, 4>, kCellCuts> table{};
    for (std::size_t cut = 0; cut < kCellCuts; ++cut)
        for (unsigned corner = 0; corner < 4; ++corner)
            table[cut][corner] = triangles_at(static_cast<CellCut>(cut), corner);
    return table;
}();

/// All sides that start at the post, counter-clockwise, and where a fan begins among them.
struct Around {
    std::size_t count = 0;
    std::array<Side, 8> sides;
    std::array<bool, 8> begins{};

    explicit Around(const std::array<CellAround, 4>& cells) {
        bool goes_on = at(cells, 3).has_last_edge;
        for (unsigned corner = 0; corner < 4; ++corner) {
            const AtCorner& here = at(cells, corner);
            for (std::size_t i = 0; i < here.count; ++i) {
                begins[count] = i == 0 && !(goes_on && here.has_first_edge);
                const auto [local, index] = here.corners[i];
                sides[count++] = Side({cells[corner].first + local}, index);
            }
            goes_on = here.has_last_edge;
        }
    }

  private:
    static const AtCorner& at(const std::array<CellAround, 4>& cells, unsigned corner) {
        return kAtCorner[static_cast<std::size_t>(cells[corner].cut)][corner];
    }
};

}  // namespace

bool has_corner(CellCut cut, unsigned corner) {
    return kAtCorner[static_cast<std::size_t>(cut)][corner].count > 0;
}

Fans fans_around(const std::array<CellAround, 4>& cells) {
    const Around around(cells);
    Fans found;
    const auto sides = around.sides.begin();
    const auto end = sides + static_cast<std::ptrdiff_t>(around.count);
    const auto first_begin = static_cast<std::size_t>(
        std::find(around.begins.begin(), around.begins.end(), true) - around.begins.begin());
    if (around.count == 0) return found;
    if (first_begin >= around.count) {  // once around: a vertex has the triangle after the lowest
        const auto lowest = std::min_element(sides, end);
        const Side after = lowest + 1 == end ? *sides : *(lowest + 1);
        found.fans[found.count++] = {*lowest, after.triangle()};
        return found;
    }
    // Otherwise the one in which the fan begins.
    for (std::size_t i = 0; i < around.count; ++i) {
        const std::size_t at = (first_begin + i) % around.count;
        const Side side = around.sides[at];
        if (around.begins[at]) found.fans[found.count++] = {side, side.triangle()};
        Fan& fan = found.fans[found.count - 1];
        fan.lowest = std::min(fan.lowest, side);
    }
    const auto lowest = std::min_element(
        found.fans.begin(), found.fans.begin() + static_cast<std::ptrdiff_t>(found.count),
        [](const Fan& a, const Fan& b) { return a.lowest < b.lowest; });
    std::swap(found.fans.front(), *lowest);
    return found;
}

}  // namespace tinsmith::core
