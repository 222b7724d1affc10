// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::cgal {

using Triple = std::array<std::uint32_t, 3>;

/// A side of one triangle: its triangle and the corner that it starts at.
struct HalfEdge {
    std::uint32_t triangle;
    std::uint32_t corner;
};

/// The sides of `triangles` from `first` on and those in `open`, matched by their ends.
struct Matching {
    std::vector<std::array<HalfEdge, 2>> pairs;
    std::vector<HalfEdge> open;  ///< those that have no other side
};
Matching match_sides(std::span<const Triple> triangles, std::size_t first,
                     std::span<const HalfEdge> open);

/// Triangles between the mesh's outline, whose sides `outline` are, and its convex hull and in its
/// holes: constrained Delaunay, no new vertex. Together with the mesh they are convex.
std::vector<Triple> fill_hull(const core::MeshData& mesh, std::span<const HalfEdge> outline);

}  // namespace tinsmith::cgal
