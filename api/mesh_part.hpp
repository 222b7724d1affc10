// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// A closed box in plan, in the session's system. Each minimum is at most its maximum.
struct PlanBox {
    double min_x = 0.0;
    double min_y = 0.0;
    double max_x = 0.0;
    double max_y = 0.0;
};

/// Part of a mesh, made a mesh of its own.
struct MeshPart {
    core::MeshData mesh;
    std::vector<std::uint32_t> triangles;  ///< the slots that its triangles had, growing
};

/// The triangles that meet the box, whole, in their order, with the vertices that they use, in
/// theirs, and the constrained edges along them. A triangle that touches the box meets it; this is
/// exact. Cost: a pass over the mesh. Requires: indices in range.
MeshPart part_within(const core::MeshData& mesh, const PlanBox& box);

}  // namespace tinsmith::api
