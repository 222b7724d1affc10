// SPDX-License-Identifier: Apache-2.0
#include "api/history.hpp"

#include <utility>

#include <nlohmann/json.hpp>

namespace tinsmith::api {

namespace {

using Json = nlohmann::ordered_json;

/// Adds the members that tell of the change.
void add_change(Json& json, const ChangeView& change) {
    json["version"] = change.version;
    json["change"] = change.change;
    if (change.of != 0) json["of"] = change.of;
    json["polygons"] = change.polygons;
    json["vertices"] = change.vertices;
    json["triangles"] = change.triangles;
}

Json number_or_null(const std::optional<std::uint64_t>& number) {
    return number ? Json(*number) : Json(nullptr);
}

}  // namespace

std::string write_change(std::string_view session, const ChangeView& change) {
    Json json{{"session", session}};
    add_change(json, change);
    return json.dump() + "\n";
}

std::string write_history(const HistoryView& history) {
    Json changes = Json::array();
    for (const ChangeView& change : history.changes) {
        Json json = Json::object();
        add_change(json, change);
        changes.push_back(std::move(json));
    }
    const Json json{{"session", history.session},
                    {"version", history.version},
                    {"oldest", history.oldest},
                    {"undo", number_or_null(history.undo)},
                    {"redo", number_or_null(history.redo)},
                    {"changes", std::move(changes)}};
    return json.dump() + "\n";
}

}  // namespace tinsmith::api
