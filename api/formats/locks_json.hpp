// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"
#include "api/formats/read_limits.hpp"
#include "core/integrate/lock.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// Reads lines, as geometries or Features: LineStrings, MultiLineStrings, and the borders of
/// Polygons and MultiPolygons. Elevations are passed over. Names every fault.
Parsed<PolygonRequest> read_lock_lines(std::string_view body, const ReadLimits& limits);

/// What is told of a locks request.
struct LocksView {
    std::string_view session;
    std::uint64_t version = 0;
    bool dry_run = false;
    bool locked = true;  ///< or unlocked
    std::span<const core::LockReport> paths;
};

/// {"session", "version", "dry_run", "locked", "edges", "changed", "length",
/// "without_edge": [{"path", "points"}]}
std::string write_locks(const LocksView& view);

/// A locked edge as it lies in the mesh.
struct LockedEdge {
    std::array<std::uint32_t, 2> vertices{};  ///< slots
    std::array<core::Point3, 2> positions{};
};

/// A Feature (RFC 7946): a MultiLineString of two positions for each edge, with the vertices' slots
/// in the foreign member "tinsmith". `crs` as in `write_feature`.
std::string write_locked_edges(std::span<const LockedEdge> edges, std::string_view crs);

}  // namespace tinsmith::api
