// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_writer.hpp"

#include <algorithm>

#include "api/formats/json_reader_text.hpp"
#include "api/formats/json_writer.hpp"
#include "api/requests.hpp"

namespace tinsmith::api {

namespace {

using Lines = std::span<const DrapedLine>;

void append_line(std::string& out, const DrapedLine& line) {
    json::append_array(out, line.positions, json::append_position);
}

void append_lines(std::string& out, Lines lines) {
    json::append_array(out, lines, append_line);
}

void append_points(std::string& out, Lines lines) {
    json::append_array(out, lines, [](std::string& text, const DrapedLine& line) {
        json::append_position(text, line.positions.front());
    });
}

/// The rings of each polygon. Requires: one line for each path.
void append_polygons(std::string& out, Lines lines, const std::vector<std::size_t>& starts) {
    out.push_back('[');
    for (std::size_t i = 0; i < starts.size(); ++i) {
        if (i > 0) out.push_back(',');
        const std::size_t end = i + 1 < starts.size() ? starts[i + 1] : lines.size();
        append_lines(out, lines.subspan(starts[i], end - starts[i]));
    }
    out.push_back(']');
}

bool is_ring(const DrapedLine& line) {
    return line.positions.size() >= 4 && line.positions.front() == line.positions.back();
}

/// Whether the lines are one for each path, whole, and rings where they should be.
bool is_whole(const DrapedPolygon& polygon) {
    if (polygon.partly_outside || polygon.lines.size() != polygon.paths) return false;
    const bool polygonal =
        polygon.type == GeometryType::Polygon || polygon.type == GeometryType::MultiPolygon;
    return std::all_of(polygon.lines.begin(), polygon.lines.end(), [&](const DrapedLine& line) {
        return polygonal ? is_ring(line) : line.positions.size() > 1;
    });
}

struct Geometry {
    GeometryType type;
    std::string coordinates;
};

std::optional<Geometry> points_of(const DrapedPolygon& polygon) {
    if (polygon.lines.empty()) return std::nullopt;
    Geometry made{polygon.type, {}};
    if (polygon.type == GeometryType::Point) {
        json::append_position(made.coordinates, polygon.lines.front().positions.front());
    } else {
        append_points(made.coordinates, polygon.lines);
    }
    return made;
}

/// What is left of lines and rings that are not whole.
std::optional<Geometry> parts_of(const DrapedPolygon& polygon) {
    std::vector<DrapedLine> parts = polygon.lines;
    std::erase_if(parts, [](const DrapedLine& line) { return line.positions.size() < 2; });
    if (parts.empty()) return std::nullopt;
    Geometry made{GeometryType::MultiLineString, {}};
    append_lines(made.coordinates, parts);
    return made;
}

std::optional<Geometry> geometry_of(const DrapedPolygon& polygon) {
    const bool are_points =
        polygon.type == GeometryType::Point || polygon.type == GeometryType::MultiPoint;
    if (are_points) return points_of(polygon);
    if (!is_whole(polygon)) return parts_of(polygon);
    Geometry made{polygon.type, {}};
    if (polygon.type == GeometryType::LineString) {
        append_line(made.coordinates, polygon.lines.front());
    } else if (polygon.type == GeometryType::MultiPolygon) {
        append_polygons(made.coordinates, polygon.lines, polygon.polygon_starts);
    } else {
        append_lines(made.coordinates, polygon.lines);
    }
    return made;
}

void append_region(std::string& out, const RegionFigures& region) {
    out.append(",\"winding\":\"").append(winding_name(region.winding)).append("\"");
    out += ",\"plan_area\":";
    json::append_number(out, region.plan_area);
    out += ",\"surface_area\":";
    json::append_number(out, region.surface_area);
    out += ",\"triangles\":";
    json::append_number(out, region.triangles);
}

/// The members of a Feature, without the braces around them.
void append_members(std::string& out, const DrapedPolygon& polygon) {
    out += "\"type\":\"Feature\"";
    if (!polygon.client_id.empty()) out.append(",\"id\":").append(polygon.client_id);
    out += ",\"geometry\":";
    if (const auto geometry = geometry_of(polygon)) {
        out.append("{\"type\":\"").append(geometry_name(geometry->type));
        out.append("\",\"coordinates\":").append(geometry->coordinates).append("}");
    } else {
        out += "null";
    }
    out.append(",\"properties\":").append(polygon.properties);
    out.append(",\"tinsmith\":{\"id\":");
    json::append_text(out, polygon.id);
    out.append(",\"partly_outside\":").append(polygon.partly_outside ? "true" : "false");
    if (polygon.region) append_region(out, *polygon.region);
    out += "}";
}

}  // namespace

void append_crs(std::string& out, std::string_view crs) {
    if (crs.empty()) return;
    out += ",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":";
    json::append_text(out, crs);
    out += "}}";
}

std::string write_feature(const DrapedPolygon& polygon, std::string_view crs) {
    std::string out = "{";
    append_members(out, polygon);
    append_crs(out, crs);
    out += "}\n";
    return out;
}

std::string write_feature_collection(std::span<const DrapedPolygon> polygons,
                                     std::string_view crs) {
    std::string out = "{\"type\":\"FeatureCollection\"";
    append_crs(out, crs);
    out += ",\"features\":";
    json::append_array(out, polygons, [](std::string& text, const DrapedPolygon& polygon) {
        text += "{";
        append_members(text, polygon);
        text += "}";
    });
    out += "}\n";
    return out;
}

}  // namespace tinsmith::api
