// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"
#include "api/formats/read_limits.hpp"
#include "core/edit/plane.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// What a surface is compared with.
struct OtherSession {
    std::string id;
};
/// Of the same session.
struct EarlierVersion {
    std::uint64_t version = 0;
};
using Against = std::variant<core::Plane, OtherSession, EarlierVersion>;

/// A volume request as its body states it.
struct VolumeRequest {
    std::optional<RequestedShape> shape;  ///< a Polygon or MultiPolygon of the body's, even-odd
    std::string polygon_id;               ///< or one of the session's; both absent: the whole mesh
    Against against;
};

/// Reads {"points": [[x, y], ...]}, at most `max_polygon_vertices` of them. Names every fault.
Parsed<std::vector<core::Point2>> read_points(std::string_view body, const ReadLimits& limits);

/// Reads {"polygon"?: a GeoJSON geometry | an id, "against": one of {"elevation"}, {"plane"},
/// {"slope", "azimuth", "point"}, {"session"}, {"version"}}. Names every fault; unknown members are
/// faults, but for those of the geometry, which are foreign.
Parsed<VolumeRequest> read_volume_request(std::string_view body, const ReadLimits& limits);

/// Reads a GeoJSON LineString, as a geometry or a Feature. Names every fault.
Parsed<PolygonRequest> read_line(std::string_view body, const ReadLimits& limits);

}  // namespace tinsmith::api
