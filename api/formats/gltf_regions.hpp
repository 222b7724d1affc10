// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tinsmith::api {

/// A polygon with an inside, as glTF's metadata tells of it.
struct RegionFeature {
    std::string id;                 ///< "p7"
    std::string client_id;          ///< the Feature's own as JSON; empty: none
    std::string properties = "{}";  ///< the Feature's own, text of a JSON object
    double plan_area = 0.0;         ///< in the square of the session's unit
    double surface_area = 0.0;
};

/// Which polygons contain which triangles: what `regions=true` makes primitives of.
struct RegionPartition {
    std::vector<RegionFeature> features;  ///< in the order in which the polygons came
    /// Each set of features that some triangle lies in, its indices growing. The first is empty:
    /// the ground outside all of them, which may have no triangle.
    std::vector<std::vector<std::uint32_t>> sets{{}};
    std::vector<std::uint32_t> set_of;  ///< by triangle, an index of `sets`
    std::string unit;                   ///< of the areas' sides
};

/// Features are numbered in 16 bits, and one number is kept for none of them.
inline constexpr std::size_t kMostRegionFeatures = 65534;
/// Feature ids of a primitive: of its newest polygons so many.
inline constexpr std::size_t kMostFeatureSets = 4;

}  // namespace tinsmith::api
