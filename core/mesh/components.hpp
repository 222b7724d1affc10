// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// The lowest triangle of each component of the mesh, in order of slot. Triangles that share an
/// edge are of one component. Cost: linear; `Tin::components` has the answer at no cost.
std::vector<TriangleId> find_components(const Tin& tin);

}  // namespace tinsmith::core
