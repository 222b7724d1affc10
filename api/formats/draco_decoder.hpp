// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::api {

/// A mesh as Draco holds it, with its points in Draco's order.
struct DracoMesh {
    std::vector<core::Point3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< their indices are in range
};

/// Why there is none: what to tell people.
struct DracoRefusal {
    std::string detail;
    bool is_too_large = false;
};

/// How many triangles or points a byte may stand for. Flat regular grids of this program's come to
/// some hundreds; what promises more lies.
inline constexpr std::size_t kMostDracoPerByte = 4096;

/// Decodes a mesh (bitstream 2.2, as glTF has it) and its attribute of that unique id. Draco
/// reserves what its headers promise, so these are held against the limits and the bytes at each
/// point before it does.
std::variant<DracoMesh, DracoRefusal> decode_draco(std::string_view bytes, std::size_t position_id,
                                                   std::size_t max_vertices,
                                                   std::size_t max_triangles);

}  // namespace tinsmith::api
