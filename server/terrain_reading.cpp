// SPDX-License-Identifier: Apache-2.0
#include "server/terrain_reading.hpp"

#include <utility>

#include "api/formats/geotiff.hpp"
#include "api/formats/terrain_json.hpp"
#include "core/mesh/build.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

api::Fault fault_of(const core::Error& error, TerrainFormat format) {
    api::Fault fault{std::string(core::code_name(error.code)), error.detail, {}};
    const bool is_json = format == TerrainFormat::Json;
    if (error.place.triangle) {
        fault.index = *error.place.triangle;
        if (is_json) fault.pointer = "/mesh/triangles/" + std::to_string(*fault.index);
    } else if (error.place.vertex) {
        fault.index = *error.place.vertex;
        if (is_json) fault.pointer = "/mesh/vertices/" + std::to_string(*fault.index);
    }
    if (error.place.position) {
        fault.coordinate = {error.place.position->x, error.place.position->y};
    }
    return fault;
}

}  // namespace

TerrainFormat terrain_format_of(std::string_view bytes) {
    // "II" or "MM" for the order of bytes, then 42, or 43 for files beyond 4 GiB.
    using namespace std::string_view_literals;
    const bool is_tiff = bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
                         bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv);
    return is_tiff ? TerrainFormat::GeoTiff : TerrainFormat::Json;
}

std::optional<TerrainFormat> terrain_format_named(std::string_view media_type) {
    if (media_type == "application/json") return TerrainFormat::Json;
    if (media_type == "image/tiff" || media_type == "image/geotiff") return TerrainFormat::GeoTiff;
    return std::nullopt;
}

api::Parsed<LoadedTerrain> load_terrain(std::string_view bytes, TerrainFormat format,
                                        const api::ReadLimits& limits) {
    begin_stage(0.4);
    auto terrain = format == TerrainFormat::GeoTiff ? api::read_geotiff(bytes, limits)
                                                    : api::read_terrain_json(bytes, limits);
    if (!terrain) return {terrain.kind(), std::move(terrain.faults())};
    begin_stage(0.6);
    auto tin = core::build_tin(terrain->mesh);
    if (told_to_stop()) return {api::FaultKind::Stopped, api::reading_stopped()};
    if (!tin) {
        api::Faults faults;
        auto kind = api::FaultKind::Invalid;
        for (const core::Error& error : tin.errors()) {
            if (error.code == core::ErrorCode::MeshTooLarge) kind = api::FaultKind::TooLarge;
            faults.push_back(fault_of(error, format));
        }
        return {kind, std::move(faults)};
    }
    terrain->mesh = {};
    return LoadedTerrain{std::move(*terrain), std::move(*tin)};
}

}  // namespace tinsmith::server
