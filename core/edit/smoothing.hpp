// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/edit/moving_vertices.hpp"
#include "core/edit/vertex_moves.hpp"

namespace tinsmith::core {

/// Where smoothing takes the vertices; the formula stands at `SmoothEdit`. Vertices at one position
/// have all their neighbours in common. The order of neighbours is that of the mesh, so that the
/// same mesh gives the same bytes. Nothing where it was cancelled; `progress`, which may be empty,
/// is told what share of the passes is done. Requires: in order of slot. Cost: passes times the
/// edges at these vertices.
std::optional<std::vector<VertexMove>> smoothed(const Tin& tin, std::span<const Moving> moving,
                                                std::uint32_t passes,
                                                const std::function<bool()>& cancelled,
                                                const std::function<void(double)>& progress);

}  // namespace tinsmith::core
