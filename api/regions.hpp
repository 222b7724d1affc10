// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/regions/region.hpp"

namespace tinsmith::api {

/// Triangles that the same other polygons contain as well.
struct SharedTriangles {
    std::vector<std::string> polygons;     ///< ids, in the order in which they came
    std::vector<std::uint32_t> triangles;  ///< slots, in order
};

/// Constrained edges that the same polygons run along.
struct RegionEdges {
    std::vector<std::string> polygons;  ///< ids, in the order in which they came
    /// Slots of the ends, the region on the left; an edge within the region once.
    std::vector<std::array<std::uint32_t, 2>> edges;
};

/// The part of the mesh inside a polygon, in the session's unit.
struct RegionView {
    std::string polygon;  ///< id
    core::Winding winding = core::Winding::EvenOdd;
    double plan_area = 0.0;
    double surface_area = 0.0;
    std::vector<std::uint32_t> triangles;  ///< slots, in order
    std::vector<std::string> within;       ///< other polygons that contain all of it
    std::vector<SharedTriangles> shared;   ///< the triangles that any other contains
    std::vector<RegionEdges> edges;        ///< all constrained edges of its triangles
};

/// {"session", "version", "unit", "polygon", "winding", "plan_area", "surface_area", "within",
/// "triangles", "shared": [{"polygons", "triangles"}], "edges": [{"polygons", "vertices"}]}
std::string write_region(std::string_view session, std::uint64_t version, std::string_view unit,
                         const RegionView& region);

/// {"session", "version", "unit", "regions": [...]}, each as above without these three.
std::string write_regions(std::string_view session, std::uint64_t version, std::string_view unit,
                          std::span<const RegionView> regions);

}  // namespace tinsmith::api
