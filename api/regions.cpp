// SPDX-License-Identifier: Apache-2.0
#include "api/regions.hpp"

#include "api/formats/json_reader_text.hpp"
#include "api/formats/json_writer.hpp"
#include "api/requests.hpp"

namespace tinsmith::api {

namespace {

void append_ids(std::string& out, const std::vector<std::string>& ids) {
    json::append_array(out, ids, json::append_text);
}

void append_slots(std::string& out, const std::vector<std::uint32_t>& slots) {
    json::append_array(out, slots, json::append_number<std::uint32_t>);
}

void append_shared(std::string& out, const SharedTriangles& shared) {
    out += "{\"polygons\":";
    append_ids(out, shared.polygons);
    out += ",\"triangles\":";
    append_slots(out, shared.triangles);
    out.push_back('}');
}

void append_edges(std::string& out, const RegionEdges& along) {
    out += "{\"polygons\":";
    append_ids(out, along.polygons);
    out += ",\"vertices\":";
    json::append_array(out, along.edges, json::append_pair<std::uint32_t>);
    out.push_back('}');
}

/// Without the braces around them.
void append_members(std::string& out, const RegionView& region) {
    out += "\"polygon\":";
    json::append_text(out, region.polygon);
    out.append(",\"winding\":\"").append(winding_name(region.winding)).append("\",\"plan_area\":");
    json::append_number(out, region.plan_area);
    out += ",\"surface_area\":";
    json::append_number(out, region.surface_area);
    out += ",\"within\":";
    append_ids(out, region.within);
    out += ",\"triangles\":";
    append_slots(out, region.triangles);
    out += ",\"shared\":";
    json::append_array(out, region.shared, append_shared);
    out += ",\"edges\":";
    json::append_array(out, region.edges, append_edges);
}

void append_head(std::string& out, std::string_view session, std::uint64_t version,
                 std::string_view unit) {
    out += "{\"session\":";
    json::append_text(out, session);
    out += ",\"version\":";
    json::append_number(out, version);
    out += ",\"unit\":";
    json::append_text(out, unit);
    out.push_back(',');
}

}  // namespace

std::string write_region(std::string_view session, std::uint64_t version, std::string_view unit,
                         const RegionView& region) {
    std::string out;
    append_head(out, session, version, unit);
    append_members(out, region);
    return out + "}\n";
}

std::string write_regions(std::string_view session, std::uint64_t version, std::string_view unit,
                          std::span<const RegionView> regions) {
    std::string out;
    append_head(out, session, version, unit);
    out += "\"regions\":";
    json::append_array(out, regions, [](std::string& text, const RegionView& region) {
        text.push_back('{');
        append_members(text, region);
        text.push_back('}');
    });
    return out + "}\n";
}

}  // namespace tinsmith::api
