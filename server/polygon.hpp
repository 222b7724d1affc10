// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/geojson.hpp"
#include "core/integrate/angle_counts.hpp"
#include "core/integrate/options.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/regions/region.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"
#include "server/delta.hpp"

namespace tinsmith::server {

/// What a polygon was when it came, beside its paths.
struct PolygonOrigin {
    std::string client_id;          ///< the Feature's own as JSON, a text or a number; empty: none
    std::string properties = "{}";  ///< the Feature's own, text of a JSON object
    api::GeometryType type = api::GeometryType::Polygon;
    std::size_t paths = 0;
    std::vector<std::size_t> polygon_starts;  ///< see api::RequestedShape
};

/// A polygons request as it is run, and run again when what came before it changes. It has no
/// budgets, no clock and no cancel: those were the request's alone.
struct PolygonsOperation {
    std::vector<core::Shape> shapes;
    std::vector<PolygonOrigin> origins;  ///< one for one with the shapes
    std::vector<std::string> ids;        ///< likewise; none is ever given to another polygon
    core::Winding winding = core::Winding::EvenOdd;  ///< what the shapes' inside is
    core::IntegrateOptions options;
};

/// A polygon that lies in the mesh. A view: it lives no longer than the session's lock is held.
struct Polygon {
    const PolygonsOperation& request;
    const core::Report& report;  ///< of the run of that request that the mesh holds
    std::size_t shape = 0;       ///< its index in both

    const std::string& id() const { return request.ids[shape]; }
    /// 7 of "p7".
    std::uint64_t number() const {
        std::uint64_t number = 0;
        std::from_chars(id().data() + 1, id().data() + id().size(), number);
        return number;
    }
    bool has_inside() const {
        return origin().type == api::GeometryType::Polygon ||
               origin().type == api::GeometryType::MultiPolygon;
    }
    const PolygonOrigin& origin() const { return request.origins[shape]; }
    const core::Shape& outline() const { return request.shapes[shape]; }
    const core::ShapeReport& own_report() const { return report.shapes[shape]; }
};

/// How large a session is, or may become.
struct SessionSize {
    std::size_t triangles = SIZE_MAX;
    std::size_t bytes = SIZE_MAX;
};

/// The shapes of one request, and where each comes from (one for one with the shapes).
struct PolygonEdit {
    std::vector<core::Shape> shapes;
    std::vector<PolygonOrigin> origins;
    core::Winding winding = core::Winding::EvenOdd;
    core::IntegrateOptions options;
    bool dry_run = false;
    bool want_mesh = false;    ///< the answer shall hold the mesh that came of it
    bool want_delta = false;   ///< the answer shall hold what changed; not of a dry run
    bool want_angles = false;  ///< the answer shall count smallest angles
    std::optional<std::uint64_t> expected_version;  ///< from If-Match
    SessionSize most = {};                          ///< of the session after the edit
};

struct PolygonResult {
    std::uint64_t version = 0;  ///< after the edit; unchanged by a dry run
    std::vector<std::string> polygon_ids;
    std::shared_ptr<const core::Report> report;
    /// If it was wanted. Absent all the same where memory ran out after the edit was made.
    std::optional<core::MeshData> mesh;
    std::optional<api::MeshDelta> delta;      ///< likewise
    std::optional<core::AngleCounts> angles;  ///< likewise
};

struct VersionMismatch {
    std::uint64_t current = 0;
};

using PolygonOutcome = std::variant<PolygonResult, core::Errors, VersionMismatch>;

}  // namespace tinsmith::server
