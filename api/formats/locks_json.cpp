// SPDX-License-Identifier: Apache-2.0
#include "api/formats/locks_json.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "api/formats/fault_log.hpp"
#include "api/formats/geojson_elevations.hpp"
#include "api/formats/geojson_writer.hpp"
#include "api/formats/json_writer.hpp"

namespace tinsmith::api {

Parsed<PolygonRequest> read_lock_lines(std::string_view body, const ReadLimits& limits) {
    auto request = read_geojson(body, limits);
    if (!request) return request;
    FaultLog log(limits.max_faults);
    for (const RequestedShape& shape : request->shapes) {
        if (shape.type != GeometryType::Point && shape.type != GeometryType::MultiPoint) continue;
        log.add(FaultKind::Invalid,
                {"GEOJSON_TYPE",
                 "A " + std::string(geometry_name(shape.type)) +
                     " lies along no edge: send a LineString, a MultiLineString or a Polygon.",
                 shape.pointer});
    }
    if (!log.empty()) return std::move(log).refusal<PolygonRequest>();
    drop_elevations(request->shapes);
    return request;
}

std::string write_locks(const LocksView& view) {
    using Json = nlohmann::ordered_json;
    std::size_t edges = 0;
    std::size_t changed = 0;
    double length = 0.0;
    Json without = Json::array();
    for (std::size_t path = 0; path < view.paths.size(); ++path) {
        const core::LockReport& report = view.paths[path];
        edges += report.edges;
        changed += report.changed;
        length += report.length;
        for (const auto& stretch : report.without_edge) {
            Json points = Json::array();
            for (const core::Point2& p : stretch)
                points.push_back({p.x, p.y});
            without.push_back({{"path", path}, {"points", std::move(points)}});
        }
    }
    const Json json{{"session", view.session}, {"version", view.version},
                    {"dry_run", view.dry_run}, {"locked", view.locked},
                    {"edges", edges},          {"changed", changed},
                    {"length", length},        {"without_edge", std::move(without)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string write_locked_edges(std::span<const LockedEdge> edges, std::string_view crs) {
    std::string out = R"({"type":"Feature","geometry":{"type":"MultiLineString","coordinates":)";
    out.reserve(out.size() + edges.size() * 140 + 128);
    json::append_array(out, edges, [](std::string& text, const LockedEdge& edge) {
        json::append_array(text, edge.positions, json::append_position);
    });
    out += R"(},"properties":{},"tinsmith":{"vertices":)";
    json::append_array(out, edges, [](std::string& text, const LockedEdge& edge) {
        json::append_pair(text, edge.vertices);
    });
    out += "}";
    append_crs(out, crs);
    return out + "}\n";
}

}  // namespace tinsmith::api
