// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads the triangles of a glTF 2.0's scene, binary or JSON with data: URIs: plain, quantized, or
/// packed by Draco or meshoptimizer. Nodes' transforms are applied in double. glTF is y up and in
/// metres: the mesh is z up, x as it was and y = -z; files of this program that are z up by their
/// own word stay so.
///
/// Vertices with equal positions, of one primitive or of several, become one; the order is the
/// file's, by first occurrence. Those that no triangle uses are left out. Lines of this program's
/// own files are constraints; other lines and points are passed over, with a note. Faults carry
/// pointers into the file's JSON. Every count, offset and stride is held against the bytes before
/// memory is reserved. Whether the triangles make a mesh is `core::build_tin`'s to say.
Parsed<Terrain> read_glb(std::string_view bytes, const ReadLimits& limits);

}  // namespace tinsmith::api
