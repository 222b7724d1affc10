// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// A terrain as any reader delivers it: mesh buffers and what is known of their coordinates.
struct Terrain {
    core::MeshData mesh;
    std::string name;            ///< empty: none given
    std::string crs;             ///< "EPSG:32616"; empty: unknown
    std::string unit = "metre";  ///< unit of all three coordinates
};

}  // namespace tinsmith::api
