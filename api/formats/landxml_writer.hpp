// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// What LandXML says of a surface beside its triangles.
struct LandXmlAbout {
    std::string name;  ///< of the surface; empty: "terrain"
    std::string crs;   ///< normalised, such as "EPSG:32616"; empty: unknown
    std::string unit;  ///< normalised: "metre", "foot" or "US survey foot"
    bool constraints = true;
};

/// The mesh as a TIN surface of LandXML 1.2: points are northing, easting, elevation, in the
/// session's unit, with ids from 1 in the order of slots; faces run counter-clockwise, in the order
/// of slots; elements are in the order that the schema wants. Constrained edges become breaklines
/// of the surface's source data, chained where they meet end to end. Numbers are the shortest text
/// that reads back to the same double. The same mesh gives the same bytes: no date is written.
std::string write_landxml(const core::MeshData& mesh, const LandXmlAbout& about);

}  // namespace tinsmith::api
