// SPDX-License-Identifier: Apache-2.0
#include "api/responses.hpp"

#include <algorithm>
#include <array>
#include <ctime>

#include <nlohmann/json.hpp>

#include "api/formats/json_writer.hpp"

namespace tinsmith::api {

namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
    // Names come from clients: what is not UTF-8 is replaced, never thrown about.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json json_of_repairs(const std::vector<core::Repair>& repairs) {
    Json list = Json::array();
    for (const core::Repair& repair : repairs)
        list.push_back({{"code", core::repair_name(repair.kind)},
                        {"count", repair.count},
                        {"indices", repair.indices}});
    return list;
}

/// RFC 3339: "2026-11-26T10:00:00Z".
std::string utc_text(std::int64_t unix_seconds) {
    const std::time_t time = unix_seconds;
    std::tm parts{};
    gmtime_r(&time, &parts);
    std::array<char, 64> text{};
    return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

Json json_of_session(const SessionView& s) {
    const core::Point3& low = s.bounds.min;
    const core::Point3& high = s.bounds.max;
    Json json = {{"id", s.id},
                 {"name", s.name},
                 {"crs", text_or_null(s.crs)},
                 {"unit", s.unit},
                 {"version", s.version},
                 {"vertices", s.vertices},
                 {"triangles", s.triangles},
                 {"bounds", {low.x, low.y, low.z, high.x, high.y, high.z}},
                 {"polygons", s.polygons},
                 {"memory_bytes", s.memory_bytes}};
    if (s.repairs) json["repairs"] = json_of_repairs(*s.repairs);
    if (!s.notes.empty()) json["notes"] = s.notes;
    if (s.expires) json["expires"] = utc_text(*s.expires);
    return json;
}

Json json_of_outside(const std::vector<core::OutsidePart>& parts) {
    Json list = Json::array();
    for (const core::OutsidePart& part : parts) {
        Json points = Json::array();
        for (const core::Point2& p : part.points)
            points.push_back({p.x, p.y});
        list.push_back({{"path", part.path}, {"points", std::move(points)}});
    }
    return list;
}

Json json_of_counts(const core::ShapeReport& shape) {
    return {{"segments", shape.segments},
            {"crossings", shape.crossings},
            {"vertices_added", shape.vertices_added},
            {"triangles_added", shape.triangles_added},
            {"edges_swapped", shape.edges_swapped}};
}

Json json_of_shape(const std::string& id, const core::ShapeReport& shape) {
    const core::AngleSummary& angle = shape.smallest_angle_deg;
    Json json{{"id", id}};
    json.update(json_of_counts(shape));
    json["outside"] = json_of_outside(shape.outside);
    json["max_vertical_deviation"] = shape.max_vertical_deviation;
    json["max_plan_deviation"] = shape.max_plan_deviation;
    json["max_elevation_change"] = shape.max_elevation_change;
    json["smallest_angle_deg"] = {{"before", angle.before},
                                  {"after", angle.after},
                                  {"p1_before", angle.p1_before},
                                  {"p1_after", angle.p1_after}};
    return json;
}

core::ShapeReport total_of(const core::Report& report) {
    core::ShapeReport total;
    for (const core::ShapeReport& shape : report.shapes) {
        total.segments += shape.segments;
        total.crossings += shape.crossings;
        total.vertices_added += shape.vertices_added;
        total.triangles_added += shape.triangles_added;
        total.edges_swapped += shape.edges_swapped;
    }
    return total;
}

void append_triangle(std::string& out, const std::array<std::uint32_t, 3>& triangle) {
    out.push_back('[');
    json::append_number(out, triangle[0]);
    out.push_back(',');
    json::append_number(out, triangle[1]);
    out.push_back(',');
    json::append_number(out, triangle[2]);
    out.push_back(']');
}

}  // namespace

std::string write_session(const SessionView& session) {
    return text_of(json_of_session(session));
}

std::string write_session_list(std::span<const SessionView> sessions) {
    Json list = Json::array();
    for (const SessionView& session : sessions)
        list.push_back(json_of_session(session));
    return text_of({{"sessions", std::move(list)}});
}

std::string write_limits(std::span<const std::pair<std::string_view, double>> limits,
                         const std::optional<KeyView>& key) {
    Json json = Json::object();
    const auto add = [](Json& to, std::string_view name, double value) {
        const bool is_whole = value == std::floor(value) && std::fabs(value) < 9e15;
        to[std::string(name)] = is_whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
    };
    for (const auto& [name, value] : limits)
        add(json, name, value);
    if (key) {
        Json& told = json["key"] = {{"name", key->name}, {"id", key->id}};
        for (const auto& [name, value] : key->quotas)
            add(told, name, value);
    }
    return text_of(json);
}

std::string write_report(const ReportView& view) {
    Json polygons = Json::array();
    const std::size_t count = std::min(view.polygon_ids.size(), view.report.shapes.size());
    for (std::size_t i = 0; i < count; ++i) {
        polygons.push_back(json_of_shape(view.polygon_ids[i], view.report.shapes[i]));
    }
    const core::StageTimes& times = view.report.time_ms;
    Json json = {
        {"session", view.session.empty() ? Json(nullptr) : Json(view.session)},
        {"version", view.version},
        {"dry_run", view.dry_run},
        {"polygons", std::move(polygons)},
        {"totals", json_of_counts(total_of(view.report))},
        {"time_ms",
         {{"locate", times.locate}, {"integrate", times.integrate}, {"improve", times.improve}}}};
    if (view.repairs) json["repairs"] = json_of_repairs(*view.repairs);
    if (view.angles) {
        json["smallest_angles"] = {{"step_deg", core::kAngleStep},
                                   {"before", view.angles->before},
                                   {"after", view.angles->after}};
    }
    return text_of(json);
}

std::string write_mesh_json(const core::MeshData& mesh) {
    std::string out;
    // About what real terrains need; the text grows beyond it where digits are many.
    out.reserve(mesh.vertices.size() * 40 + mesh.triangles.size() * 24 + 64);
    out += "{\"vertices\":[";
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (i > 0) out.push_back(',');
        json::append_position(out, mesh.vertices[i]);
    }
    out += "],\"triangles\":[";
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (i > 0) out.push_back(',');
        append_triangle(out, mesh.triangles[i]);
    }
    out += "]}\n";
    return out;
}

}  // namespace tinsmith::api
