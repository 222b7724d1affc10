// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gis_geojson.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "api/formats/geojson_writer.hpp"
#include "api/formats/gltf_features.hpp"
#include "api/formats/json_reader_text.hpp"
#include "api/formats/json_writer.hpp"

namespace tinsmith::api {
namespace {

using Json = nlohmann::json;

std::string properties_of(const RegionShape& region) {
    const RegionFeature& feature = region.feature;
    Json all{{"id", feature.id},
             {"name", region_name(feature)},
             {"plan_area", feature.plan_area},
             {"surface_area", feature.surface_area},
             {"triangles", region.triangles}};
    const Json own = Json::parse(feature.properties, nullptr, false);
    if (own.is_object()) {
        // Those whose names are free first, so that none of them gives way to one that moves.
        for (const auto& [name, value] : own.items()) {
            if (!all.contains(name)) all[name] = value;
        }
        for (const char* name : {"id", "name", "plan_area", "surface_area", "triangles"}) {
            const auto found = own.find(name);
            if (found == own.end() || all[name] == *found) continue;
            std::string free = std::string(name) + "_2";
            while (all.contains(free))
                free += "_2";
            all[free] = *found;
        }
    }
    return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_region(std::string& out, const RegionShape& region) {
    out += "\"type\":\"Feature\",\"id\":";
    json::append_text(out, region.feature.id);
    out += ",\"geometry\":";
    if (region.polygons.empty()) {
        out += "null";
    } else {
        out += "{\"type\":\"MultiPolygon\",\"coordinates\":";
        json::append_array(out, region.polygons, [](std::string& text, const auto& rings) {
            json::append_array(text, rings, [](std::string& inner, const Ring3& ring) {
                json::append_array(inner, ring, json::append_position);
            });
        });
        out += "}";
    }
    out.append(",\"properties\":").append(properties_of(region));
}

double length_of(const std::vector<core::Point3>& positions) {
    double sum = 0.0;
    for (std::size_t i = 1; i < positions.size(); ++i)
        sum += std::hypot(positions[i].x - positions[i - 1].x, positions[i].y - positions[i - 1].y);
    return sum;
}

template <typename Items, typename Append>
std::string collection(const Items& items, std::string_view crs, const Append& append) {
    std::string out = "{\"type\":\"FeatureCollection\"";
    append_crs(out, crs);
    out += ",\"features\":";
    json::append_array(out, items, [&append](std::string& text, const auto& item) {
        text += "{";
        append(text, item);
        text += "}";
    });
    out += "}\n";
    return out;
}

}  // namespace

std::string write_region_features(std::span<const RegionShape> regions, std::string_view crs) {
    return collection(regions, crs, append_region);
}

std::string write_region_feature(const RegionShape& region, std::string_view crs) {
    std::string out = "{";
    append_region(out, region);
    append_crs(out, crs);
    out += "}\n";
    return out;
}

std::string write_constraint_lines(std::span<const ConstraintLine> lines, std::string_view crs) {
    return collection(lines, crs, [](std::string& out, const ConstraintLine& line) {
        out += "\"type\":\"Feature\",\"geometry\":{\"type\":\"LineString\",\"coordinates\":";
        json::append_array(out, line.positions, json::append_position);
        out += "},\"properties\":{\"polygons\":";
        json::append_array(out, line.polygons, json::append_text);
        out.append(",\"locked\":").append(line.is_locked ? "true" : "false");
        out += ",\"length\":";
        json::append_number(out, length_of(line.positions));
        out += "}";
    });
}

}  // namespace tinsmith::api
