// SPDX-License-Identifier: Apache-2.0
// How a cell of a grid is cut into triangles, by its posts at the corners of the compass, whatever
// way the grid is stored.
//
//     nw 3 --- edge 2 --- ne 2
//      |                   |       edge i runs from corner i to corner (i + 1) mod 4,
//    edge 3             edge 1     counter-clockwise
//      |                   |
//     sw 0 --- edge 0 --- se 1
//
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace tinsmith::core {

enum class CellCut : std::uint8_t {
    None,       ///< two posts or more have no data
    WithoutSw,  ///< one post has none: one triangle of the other three
    WithoutSe,
    WithoutNe,
    WithoutNw,
    Rising,   ///< two triangles, the diagonal from south-west to north-east
    Falling,  ///< two triangles, the diagonal from north-west to south-east
};
inline constexpr std::size_t kCellCuts = 7;

/// Two triangles where all four posts have data, one where exactly three have. The diagonal joins
/// the two opposite posts that differ less in elevation; on a tie it rises.
inline CellCut cut_of(double sw, double se, double ne, double nw) {
    const double rising = std::fabs(sw - ne), falling = std::fabs(se - nw);
    const bool rises = rising <= falling, falls = falling < rising;
    // Neither is more likely: a branch would be foreseen wrongly every other time.
    if (rises | falls) return static_cast<CellCut>(6 - static_cast<int>(rises));
    const int holes = std::isnan(sw) + std::isnan(se) + std::isnan(ne) + std::isnan(nw);
    if (holes == 0) return CellCut::Falling;  // of infinities, which no mesh is made of
    if (holes > 1) return CellCut::None;
    return std::isnan(sw)   ? CellCut::WithoutSw
           : std::isnan(se) ? CellCut::WithoutSe
           : std::isnan(ne) ? CellCut::WithoutNe
                            : CellCut::WithoutNw;
}

/// The triangle of a cell without one of its corners: the other three, counter-clockwise, from the
/// lowest on.
inline constexpr std::array<std::array<unsigned, 3>, 4> kTriangleWithout{
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// The triangles of a cut, in order, by the corner that each is without.
struct CutTriangles {
    unsigned count = 0;
    std::array<unsigned, 2> without{};
};
inline constexpr std::array<CutTriangles, kCellCuts> kCutTriangles{
    {{0, {}}, {1, {0}}, {1, {1}}, {1, {2}}, {1, {3}}, {2, {3, 1}}, {2, {2, 0}}}};

constexpr const CutTriangles& triangles_of(CellCut cut) {
    return kCutTriangles[static_cast<std::size_t>(cut)];
}

}  // namespace tinsmith::core
