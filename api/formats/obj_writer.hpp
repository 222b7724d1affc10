// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// The mesh as Wavefront OBJ, z up, in the session's system and unit: a line `v x y z` for each
/// vertex and `f a b c` for each triangle, in the order of slots, numbered from 1; and, if wanted,
/// `l a b` for each constrained edge, in an object of their own. Numbers are the shortest text that
/// reads back to the same double, so that reading the file gives the same mesh. `comment` is one
/// line.
std::string write_obj(const core::MeshData& mesh, bool constraints, const std::string& comment);

}  // namespace tinsmith::api
