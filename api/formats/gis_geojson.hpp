// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/gltf_regions.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

using Ring3 = std::vector<core::Point3>;  ///< ends where it began

/// The part of a mesh inside a polygon, as polygons on the ground.
struct RegionShape {
    RegionFeature feature;
    std::size_t triangles = 0;
    std::vector<std::vector<Ring3>> polygons;  ///< the outer ring first, then holes
};

/// Constrained edges end to end, and the polygons, lines and points that run along all of them.
struct ConstraintLine {
    std::vector<std::string> polygons;  ///< ids; none: an edit made it
    std::vector<core::Point3> positions;
    bool is_locked = false;
};

/// A FeatureCollection for GIS programs, which read `properties` alone: of each region id, name,
/// plan_area, surface_area and triangles beside the Feature's own, which where they have such a
/// name get "_2" behind it. MultiPolygons, null where nothing is inside. For `crs` see
/// `write_feature`.
std::string write_region_features(std::span<const RegionShape> regions, std::string_view crs);
/// The same as one Feature.
std::string write_region_feature(const RegionShape& region, std::string_view crs);

/// A FeatureCollection of LineStrings with polygons, locked and length (in plan).
std::string write_constraint_lines(std::span<const ConstraintLine> lines, std::string_view crs);

}  // namespace tinsmith::api
