// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/edit/plane.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/ids.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// What is between a surface and one that it is compared with, in the session's unit, its square
/// and its cube. Areas are in plan.
struct Volume {
    double cut = 0.0;         ///< where the surface is above the other: what is to be taken away
    double fill = 0.0;        ///< where it is below the other: what is to be put there
    double area = 0.0;        ///< compared: where both surfaces are
    double cut_area = 0.0;    ///< of it, where the surface is above
    double fill_area = 0.0;   ///< of it, where it is below; the rest is level with the other
    std::uint64_t pairs = 0;  ///< pairs of triangles that overlap; of a plane its triangles
};

/// Every triangle of the mesh, in order of slot.
std::vector<TriangleId> all_triangles(const Tin& tin);

/// Cut and fill between some of the mesh's triangles and a plane.
/// Laws, here and below: the difference is integrated in closed form over each piece on which it is
/// linear, cut at its zero line; nothing is sampled. The sums are compensated and in a fixed order.
/// So the figures are right to about 1e-14 of the areas times the range of elevations; cut and fill
/// are never negative.
/// Cost: linear.
Volume volume_against(const Tin& tin, std::span<const TriangleId> triangles, const Plane& plane);

/// Cut and fill between some of the mesh's triangles and another mesh, by the overlay of each pair
/// of triangles: which pairs overlap is decided exactly, the pieces are right to rounding. What
/// only one of the meshes covers is not compared. Exchanging the two exchanges cut and fill.
/// Errors: cancelled.
/// Cost: n log^2 n in the triangles, and linear in pairs whose boxes meet: about the pairs that
/// overlap, times the same small number for all but long slanting triangles side by side.
Result<Volume> volume_between(const Tin& tin, std::span<const TriangleId> triangles,
                              const Tin& other, const std::function<bool()>& cancelled = {},
                              const std::function<void(double)>& progress = {});

}  // namespace tinsmith::core
