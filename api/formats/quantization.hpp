// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "api/unwritten.hpp"
#include "core/types/executor.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// Position bits that pass through Draco bit for bit. Measured with tests/gltf/decoder_bits.mjs on
/// a grid of a power of two, for values from zero and from far below zero:
///
///   | bits  | draco3d 1.5.7, 1.5.9 | three 0.187, js and wasm | @loaders.gl/draco 4.5.4 |
///   |-------|----------------------|--------------------------|-------------------------|
///   | 16-23 | exact                | exact                    | exact                   |
///   | 24    | a third one step off | the same                 | the same                |
///   | 25-28 | points fall together | the same                 | the same                |
///
/// The bound is the encoder's, not a client's: it quantizes with floor(v + 0.5f), and from 2^23 on
/// the odd float32 plus a half rounds to the next even number.
inline constexpr unsigned kDracoBits = 23;
inline constexpr std::int32_t kDracoSteps = (std::int32_t{1} << kDracoBits) - 1;

/// Every whole number up to this magnitude is a float32, so a position that is this many steps of
/// a power of two away from its node is exact for every client.
inline constexpr std::int32_t kFloatSteps = std::int32_t{1} << 24;

/// Grid coordinates never pass this magnitude: differences fit 32 bits, areas 64.
inline constexpr std::int32_t kGridLimit = std::int32_t{1} << 30;

/// Steps go from 2^-20 m, about a micrometre, to 2^30 m. With the smallest, a metre is 2^20 steps,
/// so that whole-metre translations still bring every tile near its node.
inline constexpr int kFinestExponent = -20;
inline constexpr int kCoarsestExponent = 30;

/// A position in steps from a grid's origin; axes as the function says.
using GridPoint = std::array<std::int32_t, 3>;

/// A closed box; empty while low > high.
template <typename T>
struct Box {
    std::array<T, 3> low{std::numeric_limits<T>::max(), std::numeric_limits<T>::max(),
                         std::numeric_limits<T>::max()};
    std::array<T, 3> high{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::lowest(),
                          std::numeric_limits<T>::lowest()};

    void add(const std::array<T, 3>& point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    void add(const Box& box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], box.low[axis]);
            high[axis] = std::max(high[axis], box.high[axis]);
        }
    }
};

/// A cubic lattice: origin + step * whole numbers, in metres, axes of the session (z up).
/// The origin is whole metres near the middle of the mesh, the step a power of two, so that
/// origin + step * n is exact in double, and step * n in float32 while |n| <= kFloatSteps.
struct PositionGrid {
    std::array<double, 3> origin{};
    int exponent = 0;

    double step() const;
    /// Whole metres and whole steps meet again after so many steps; at least 1.
    std::int32_t period() const;
};

/// How the corners of triangles came out: `flipped` are clockwise seen from above, `collapsed`
/// have no area in plan.
struct PlanCheck {
    std::size_t flipped = 0;
    std::size_t collapsed = 0;

    std::size_t faults() const { return flipped + collapsed; }
    void add(const PlanCheck& check) {
        flipped += check.flipped;
        collapsed += check.collapsed;
    }
};

/// The box of all vertices in the session's unit; NaN where a coordinate is not finite. Cost: one
/// pass.
Box<double> bounds_of(const core::MeshData& mesh,
                      const core::Executor& executor = core::one_after_another);

/// A box of the session in metres. Requires: the unit is positive.
Box<double> in_metres(Box<double> bounds, double unit_to_metre);

/// The whole-metre position nearest to the middle of the box.
std::array<double, 3> whole_metre_middle(const Box<double>& bounds);

/// The coarsest grid whose rounding moves no coordinate within `bounds` by more than `tolerance`
/// (half a step, with room for the rounding of doubles). Nothing when that grid would be finer
/// than kFinestExponent or the bounds wider than kGridLimit steps.
/// Requires: tolerance > 0, bounds finite.
std::optional<PositionGrid> grid_for(const Box<double>& bounds, double tolerance);

/// A tolerance in metres that `grid_for` grants for these bounds, the finest but for a factor of
/// two.
double finest_tolerance(const Box<double>& bounds);

/// Vertices on a grid.
struct GridVertices {
    Unwritten<GridPoint> points;  ///< axes of the session
    /// The largest distance on each axis, in metres, between a vertex and what a client computes
    /// for it: grid origin + step * n, in double.
    std::array<double, 3> axis_error{};
};

/// Each vertex at its nearest grid point. Cost: one pass.
/// Requires: the grid was made for this mesh's bounds.
GridVertices quantize(const core::MeshData& mesh, double unit_to_metre, const PositionGrid& grid,
                      const core::Executor& executor = core::one_after_another);

/// Looks at every triangle in plan, in integers and thus exactly. Cost: one pass.
/// Requires: |coordinates| <= kGridLimit.
PlanCheck check_plan(std::span<const GridPoint> points,
                     std::span<const std::array<std::uint32_t, 3>> triangles,
                     const core::Executor& executor = core::one_after_another);

/// A mesh on a grid, and how its triangles came out.
struct GridPositions {
    PositionGrid grid;
    GridVertices vertices;
    PlanCheck check;
};

/// The mesh on that grid; or on the coarsest of those finer ones on which fewest triangles are
/// flipped or collapsed. Finer ones count while the box of the points is at most `span` steps wide
/// on each axis and within half of that of the origin, so that no primitive more comes of it.
/// Cost: two passes where nothing is flipped or collapsed; else two more for each grid that mends
/// some of these, at most kDracoBits.
GridPositions best_positions(const core::MeshData& mesh, double unit_to_metre,
                             const PositionGrid& coarsest, std::int32_t span,
                             const core::Executor& executor = core::one_after_another);

/// Items sorted into tiles, each tile's indices rising.
struct Tiling {
    std::vector<std::vector<std::uint32_t>> tiles;
    std::vector<std::uint32_t> too_large;  ///< wider than half of `span` on some axis
};

/// Sorts boxes into tiles no wider than `span` steps on any axis: strips by x, cut by y, cut by z,
/// each cut placed as late as it can be, which makes the fewest on its axis. The same input gives
/// the same tiles. Items wider than half of `span` are set apart, so that every cut moves on by at
/// least half a span and the number of tiles is bounded by the extent, not by the items.
/// Cost: a pass over what is left for each cut; no sorting.
Tiling split_into_tiles(std::span<const Box<std::int32_t>> boxes, std::int32_t span);

}  // namespace tinsmith::api
