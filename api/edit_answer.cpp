// SPDX-License-Identifier: Apache-2.0
#include "api/edit_answer.hpp"

#include <nlohmann/json.hpp>

namespace tinsmith::api {

std::string write_edit(std::string_view session, std::uint64_t version, bool dry_run,
                       const EditAnswer& edit) {
    using Json = nlohmann::ordered_json;
    const core::EditReport& report = edit.report;
    Json json{{"session", session},
              {"version", version},
              {"dry_run", dry_run},
              {"operation", edit_name(edit.kind)},
              {"polygon", edit.polygon}};
    if (edit.kind != EditKind::Remove && edit.kind != EditKind::Keep)
        json["border"] = edit.moves_border ? "new" : "old";
    if (edit.rim) json["rim"] = *edit.rim;
    if (edit.taper) json["taper"] = *edit.taper;
    json["vertices_moved"] = report.vertices_moved;
    json["triangles_affected"] = report.triangles_affected;
    json["vertices_added"] = report.vertices_added;
    json["triangles_added"] = report.triangles_added;
    json["vertices_removed"] = report.vertices_removed;
    json["triangles_removed"] = report.triangles_removed;
    json["cut"] = report.cut;
    json["fill"] = report.fill;
    json["area_affected"] = report.area_affected;
    json["max_elevation_change"] = report.max_elevation_change;
    json["time_ms"] = {{"locate", report.time_ms.locate},
                       {"integrate", report.time_ms.integrate},
                       {"improve", report.time_ms.improve},
                       {"apply", report.apply_ms}};
    // The client's own bytes may stand in the polygon's name.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tinsmith::api
