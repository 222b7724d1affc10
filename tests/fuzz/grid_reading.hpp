// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

#include "api/formats/grid_mesh.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/same_state.hpp"

namespace tinsmith::fuzz {

/// What a reader of grids answered: faults that are few, or a grid, whose mesh is the same in every
/// bit whether it is made of its triangles or of the grid itself.
inline int check_grid(api::Parsed<api::Terrain> parsed, const api::ReadLimits& limits) {
    if (!parsed) {
        if (parsed.faults().empty() || parsed.faults().size() > limits.max_faults) std::abort();
        return 0;
    }
    if (!parsed->grid) std::abort();
    if (parsed->grid->elevations.size() > limits.max_vertices) std::abort();
    const auto straight = api::tin_of_grid(*parsed->grid, limits);
    const auto mesh = api::mesh_of_grid(*parsed->grid, limits);
    if (!mesh) {
        if (straight) std::abort();
        return 0;
    }
    const auto built = core::build_tin(*mesh);
    if (!straight) return 0;
    if (!built || test::differing_member(*built, *straight) >= 0) std::abort();
    return 0;
}

}  // namespace tinsmith::fuzz
