// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "core/integrate/shape.hpp"

namespace tinsmith::api {

enum class GeometryType { Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon };

/// The word of RFC 7946 for a geometry: "MultiPolygon".
std::string_view geometry_name(GeometryType type);

/// One geometry of the request with the way back to where it was written.
struct RequestedShape {
    /// Paths have elevations as they were written, where any of their positions has one: NaN for
    /// the positions without. See geojson_elevations.hpp for how they become fit for the core.
    core::Shape shape;
    GeometryType type = GeometryType::Polygon;
    std::string pointer;            ///< JSON Pointer of the geometry; "" when it is the body itself
    std::string id;                 ///< the Feature's id as JSON, a text or a number; empty: none
    std::string properties = "{}";  ///< the Feature's properties, the text of a JSON object
    /// MultiPolygon only: for each polygon the index of its first path. Ascending.
    std::vector<std::size_t> polygon_starts;
    /// Polygons and MultiPolygons only: of each ring's last position, which its path leaves out.
    /// NaN: it has none.
    std::vector<double> closing_elevations;
};

/// JSON Pointer of one path, a ring, a line or a single position: "/geometry/coordinates/0".
/// Requires: `path` names a path of `shape`.
std::string path_pointer(const RequestedShape& shape, std::size_t path);

/// JSON Pointer of one position: "/features/3/geometry/coordinates/0/17".
/// Requires: `path` and `point` name a point of `shape`, or the one after a ring's last: its
/// repeated first.
std::string coordinate_pointer(const RequestedShape& shape, std::size_t path, std::size_t point);

/// A polygons request as its body states it.
struct PolygonRequest {
    std::vector<RequestedShape> shapes;  ///< one for each Feature, in order; never empty
    /// Members of the body's "tinsmith" object in order, values as text: "true", "0.25", "drape".
    /// The pointer of one is "/tinsmith/" and its name. Names are not checked here, nor repeated.
    std::vector<std::pair<std::string, std::string>> options;
    /// From a legacy "crs" member or the "coordRefSys" of JSON-FG, "EPSG:32616"; empty: none.
    std::string crs;
    std::string crs_pointer;  ///< of that member
};

/// Reads a GeoJSON geometry, Feature or FeatureCollection (RFC 7946, but in whatever system the
/// request names; see shape_crs.hpp). A ring becomes a closed path without its repeated last
/// position; a position a path of one point. Numbers of a position beyond the third are passed
/// over, and so are foreign members. GeometryCollections are refused: their members can be
/// Features. Names every fault, not only the first.
Parsed<PolygonRequest> read_geojson(std::string_view body, const ReadLimits& limits);

}  // namespace tinsmith::api
