// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::core {

/// What can be mended of a mesh without a doubt about the surface that was meant.
enum class RepairKind {
    VerticesWelded,     ///< nearer to an earlier vertex than the tolerance, or equal to it
    TrianglesFlat,      ///< without area in plan: left out
    TrianglesTurned,    ///< clockwise seen from above: turned round
    TrianglesRepeated,  ///< of the three vertices of an earlier one: left out
    VerticesUnused,     ///< of no triangle: left out
};

/// The word on the wire: "VERTICES_WELDED".
std::string_view repair_name(RepairKind kind);

/// How many were mended, and which: the first of them, by their numbers in the mesh as it came.
struct Repair {
    static constexpr std::size_t kFirst = 10;

    RepairKind kind{};
    std::size_t count = 0;
    std::vector<std::size_t> indices;
};

/// What was done, and what each vertex and triangle that is left was called before.
struct Repaired {
    std::vector<Repair> repairs;  ///< in the order in which they were made; only those that were
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> triangles;
};

/// Mends a mesh in place: welds vertices, then leaves out flat triangles, turns clockwise ones,
/// leaves out repeated ones and then vertices that nothing uses. The order of the rest stays.
///
/// A vertex is welded to the nearest of those that are kept and come before it, when that is within
/// `weld` in plan and in elevation both: none moves farther, and two elevations in one place stay
/// two. With `weld` 0, or below 2^-50 of the extent, only equal positions are welded.
///
/// Whatever else is wrong stays for `build_tin` to refuse. A mesh with an index out of range or a
/// coordinate that it would refuse is left as it is.
/// Requires: weld is finite and not negative. Cost: about linear, O(n log n) at worst.
Repaired repair_mesh(MeshData& data, double weld);

}  // namespace tinsmith::core
