// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/fault.hpp"
#include "core/mesh/repair.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/post_grid.hpp"

namespace tinsmith::api {

/// How a terrain's bytes are to be taken. What they say themselves comes first; where that and an
/// option contradict each other, the terrain is refused.
struct TerrainOptions {
    bool repair = false;  ///< mend what can be mended safely, and tell each repair
    double weld = 0.0;    ///< with `repair`: vertices no farther apart than this become one
    std::string project;  ///< degrees: "auto" or the system to warp to; empty: refuse them
    std::string crs;      ///< "EPSG:32616"; empty: what the bytes say
    std::string unit;     ///< "metre"; empty: what the bytes or the system say
};

/// Says in a fault where the point of its index was read, and the earlier one that it contradicts,
/// in the format's own way.
using PlacePoint =
    std::function<void(Fault& fault, std::size_t point, std::optional<std::size_t> earlier)>;

/// Where points stand in the bytes.
struct PointsPlace {
    std::string pointer;  ///< of all of them; empty: the format has none
    PlacePoint of_point;
};

/// A terrain as any reader delivers it: mesh buffers and what is known of their coordinates.
struct Terrain {
    core::MeshData mesh;
    /// In place of a mesh: posts whose triangles are not made yet (grid_mesh.hpp).
    std::optional<core::PostGrid> grid;
    /// The mesh is vertices only, which are to be triangulated once they lie in a plan
    /// (points_mesh.hpp).
    std::optional<PointsPlace> points;
    std::string name;            ///< empty: none given
    std::string crs;             ///< "EPSG:32616"; empty: unknown
    std::string unit = "metre";  ///< unit of all three coordinates
    bool unit_is_said = false;   ///< by the bytes; otherwise it is only assumed
    std::string unit_before;     ///< that the lengths had before they became metres; empty: unknown
    bool settled = false;        ///< system and unit stand, with all that the options say
    std::vector<std::string> notes;  ///< what was passed over, a sentence each, for people
    /// Of JSON: where `vertices` and `triangles` stand.
    std::string mesh_pointer = "/mesh";
    bool triangles_are_made = false;  ///< of points or a grid: the bytes have none
    /// What points were numbered in the bytes, where some were left out. Empty: as the vertices.
    std::vector<std::uint32_t> vertex_names;
    /// Where a vertex or a triangle stands in the bytes, for people: "line 12". Empty: its index
    /// says it as well.
    std::function<std::string(std::size_t)> vertex_place;
    std::function<std::string(std::size_t)> triangle_place;
    /// Where mending was asked for: what was done.
    std::optional<std::vector<core::Repair>> repairs;
};

}  // namespace tinsmith::api
