// SPDX-License-Identifier: Apache-2.0
#include "api/answers.hpp"

#include <nlohmann/json.hpp>

#include "api/formats/json_writer.hpp"

namespace tinsmith::api {

namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const AnswerHead& head) {
    return {{"session", head.session}, {"version", head.version}, {"unit", head.unit}};
}

/// The answer's head as a text that goes on: without the closing brace.
std::string opened(const Json& json) {
    std::string out = text_of(json);
    out.pop_back();
    return out;
}

std::string_view word_of(core::ProfilePoint::Kind kind) {
    switch (kind) {
        case core::ProfilePoint::Kind::Input:
            return "input";
        case core::ProfilePoint::Kind::Edge:
            return "edge";
        case core::ProfilePoint::Kind::Vertex:
            break;
    }
    return "vertex";
}

void append_point(std::string& out, const core::ProfilePoint& point) {
    out += "{\"distance\":";
    json::append_coordinate(out, point.distance);
    out += ",\"position\":[";
    json::append_coordinate(out, point.position.x);
    out.push_back(',');
    json::append_coordinate(out, point.position.y);
    out += "],\"elevation\":";
    json::append_coordinate(out, point.position.z);
    out += ",\"triangle\":";
    json::append_number(out, point.triangle.value);
    out += ",\"at\":\"";
    out += word_of(point.kind);
    out += "\"}";
}

/// However it was asked for: a level by its elevation, a plane by a point and what it rises.
Json json_of(const core::Plane& plane) {
    if (plane.per_x == 0.0 && plane.per_y == 0.0) return {{"elevation", plane.at.z}};
    return {{"plane",
             {{"point", {plane.at.x, plane.at.y, plane.at.z}},
              {"per_x", plane.per_x},
              {"per_y", plane.per_y}}}};
}

}  // namespace

std::string write_elevation(const AnswerHead& head, core::Point2 at, const core::Spot& spot,
                            std::span<const std::string> polygons) {
    Json json = json_of(head);
    json["x"] = at.x;
    json["y"] = at.y;
    json["elevation"] = spot.elevation;
    json["triangle"] = spot.triangle.value;
    json["polygons"] = std::vector<std::string>(polygons.begin(), polygons.end());
    return text_of(json) + "\n";
}

std::string write_elevations(const AnswerHead& head,
                             std::span<const std::optional<core::Spot>> spots,
                             std::span<const core::Point2> brought) {
    std::string out = opened(json_of(head));
    out.reserve(out.size() + spots.size() * (brought.empty() ? 48 : 100) + 16);
    out += ",\"points\":[";
    for (std::size_t i = 0; i < spots.size(); ++i) {
        if (i > 0) out.push_back(',');
        if (spots[i]) {
            out += "{\"elevation\":";
            json::append_coordinate(out, spots[i]->elevation);
            out += ",\"triangle\":";
            json::append_number(out, spots[i]->triangle.value);
        } else {
            out += R"({"elevation":null,"triangle":null,"reason":"outside-mesh")";
        }
        if (i < brought.size()) {
            out += ",\"x\":";
            json::append_coordinate(out, brought[i].x);
            out += ",\"y\":";
            json::append_coordinate(out, brought[i].y);
        }
        out.push_back('}');
    }
    return out + "]}\n";
}

std::string write_profile(const AnswerHead& head, const core::Profile& profile) {
    Json json = json_of(head);
    json["length"] = profile.length;
    json["crossings"] = profile.crossings;
    std::string out = opened(json);
    out.reserve(out.size() + (profile.crossings + 2) * 140);
    out += ",\"stretches\":[";
    for (std::size_t i = 0; i < profile.stretches.size(); ++i) {
        out += i > 0 ? ",{\"points\":[" : "{\"points\":[";
        const auto& points = profile.stretches[i].points;
        for (std::size_t k = 0; k < points.size(); ++k) {
            if (k > 0) out.push_back(',');
            append_point(out, points[k]);
        }
        out += "]}";
    }
    return out + "]}\n";
}

std::string write_volume(const VolumeView& view) {
    Json json = json_of(view.head);
    json["polygon"] = view.polygon.empty() ? Json(nullptr) : Json(view.polygon);
    if (const auto* other = std::get_if<OtherSession>(&view.against)) {
        json["against"] = {{"session", other->id}, {"version", view.other_version}};
    } else if (std::holds_alternative<EarlierVersion>(view.against)) {
        json["against"] = {{"version", view.other_version}};
    } else {
        json["against"] = json_of(std::get<core::Plane>(view.against));
    }
    const core::Volume& volume = view.volume;
    json["cut"] = volume.cut;
    json["fill"] = volume.fill;
    json["area"] = volume.area;
    json["cut_area"] = volume.cut_area;
    json["fill_area"] = volume.fill_area;
    json["area_left_out"] = view.area_left_out;
    json["pairs"] = volume.pairs;
    return text_of(json) + "\n";
}

}  // namespace tinsmith::api
