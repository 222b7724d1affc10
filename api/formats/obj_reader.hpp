// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads the faces of a Wavefront OBJ as they stand, z up: x, y and z of `v` are east, north and
/// up. Vertices and triangles keep the file's order. A face of more corners becomes triangles about
/// one of them that sees all others in one turn, which every convex one has; a face without such a
/// corner is a fault. Materials, groups, normals, texture coordinates and colours are passed over;
/// lines and points too, with a note, but for lines of this program's own files, which are
/// constraints. Curves and surfaces are refused.
/// Faults name their line. Whether the triangles make a mesh is `core::build_tin`'s to say.
/// Cost: linear; memory: the result, and a number for each of its vertices and triangles.
Parsed<Terrain> read_obj(std::string_view bytes, const ReadLimits& limits);

}  // namespace tinsmith::api
