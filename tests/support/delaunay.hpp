// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tinsmith::test {

/// A position on a lattice of at most 2^20 steps a side, so that every determinant is exact.
struct LatticePoint {
    std::int64_t x;
    std::int64_t y;
    friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

/// The Delaunay triangulation of the points, counter-clockwise; none where all are on one line.
/// Requires: the points are distinct. For small numbers: its cost is more than quadratic.
std::vector<std::array<std::uint32_t, 3>> delaunay(const std::vector<LatticePoint>& points);

}  // namespace tinsmith::test
