// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "tests/cgal/peer.hpp"

namespace tinsmith::cgal {

/// The terrain of tests/data, as the product reads it. Throws where it is missing.
core::MeshData bundled_terrain();
/// The one shape of tests/data/NAME.geojson. Throws where it is missing.
core::Shape bundled_shape(const std::string& name);

/// The shape's paths with the mesh's elevations. Requires: no point is outside the mesh.
std::vector<Polyline> drape(const core::Tin& tin, const core::Shape& shape);

}  // namespace tinsmith::cgal
