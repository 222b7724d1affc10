// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/geojson.hpp"
#include "core/regions/region.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// A stretch of a path as it lies on the surface, with every vertex of the mesh along it.
struct DrapedLine {
    std::size_t path = 0;
    std::vector<core::Point3> positions;
};

/// The part of the mesh inside a polygon, in the session's unit.
struct RegionFigures {
    core::Winding winding = core::Winding::EvenOdd;
    double plan_area = 0.0;
    double surface_area = 0.0;
    std::size_t triangles = 0;
};

/// What was integrated, as it lies in the mesh.
struct DrapedPolygon {
    std::string id;
    std::string client_id;   ///< the Feature's own as JSON; empty: none
    std::string properties;  ///< the Feature's own, text of a JSON object
    GeometryType type = GeometryType::Polygon;
    std::size_t paths = 0;                    ///< that it was given
    std::vector<std::size_t> polygon_starts;  ///< see RequestedShape
    std::vector<DrapedLine> lines;            ///< by path, along it; a ring ends where it began
    bool partly_outside = false;
    std::optional<RegionFigures> region;  ///< of polygons only
};

/// A Feature (RFC 7946) with the geometry on the surface, the properties it came with, and the
/// foreign member "tinsmith". A geometry that does not lie on the mesh as a whole becomes the
/// lines of it that do, a MultiLineString; null where there are none. `crs`, if not empty, is
/// named in the manner of GeoJSON 2008, without which other programs would take degrees for it.
std::string write_feature(const DrapedPolygon& polygon, std::string_view crs);
std::string write_feature_collection(std::span<const DrapedPolygon> polygons, std::string_view crs);

/// Appends that member, with a comma in front.
void append_crs(std::string& out, std::string_view crs);

}  // namespace tinsmith::api
