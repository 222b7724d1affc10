// SPDX-License-Identifier: Apache-2.0
#include "server/terrain_reading.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "api/formats/ascii_grid.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/terrain_json.hpp"
#include "api/terrain_system.hpp"
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

/// One format: what it is called, and who reads it.
struct Reader {
    TerrainFormat format;
    std::span<const std::string_view> media_types;
    api::Parsed<api::Terrain> (*read)(std::string_view bytes, const api::TerrainOptions& options,
                                      const api::ReadLimits& limits);
};

constexpr std::string_view kJsonTypes[] = {"application/json"};
constexpr std::string_view kAsciiGridTypes[] = {"text/plain"};
constexpr std::string_view kTiffTypes[] = {"image/tiff", "image/geotiff"};

constexpr Reader kReaders[] = {
    {TerrainFormat::Json, kJsonTypes,
     [](std::string_view bytes, const api::TerrainOptions&, const api::ReadLimits& limits) {
         return api::read_terrain_json(bytes, limits);
     }},
    {TerrainFormat::GeoTiff, kTiffTypes,
     [](std::string_view bytes, const api::TerrainOptions& options, const api::ReadLimits& limits) {
         return api::read_geotiff(bytes, limits, options);
     }},
    {TerrainFormat::AsciiGrid, kAsciiGridTypes,
     [](std::string_view bytes, const api::TerrainOptions& options, const api::ReadLimits& limits) {
         return api::read_ascii_grid(bytes, options, limits);
     }},
};

/// Only JSON has members that faults can point to.
api::Parsed<api::Terrain> settled(api::Terrain terrain, TerrainFormat format,
                                  const api::TerrainOptions& options,
                                  const api::ReadLimits& limits) {
    auto out = api::in_its_system(std::move(terrain), options, limits);
    if (out || format == TerrainFormat::Json) return out;
    for (api::Fault& fault : out.faults())
        fault.pointer.clear();
    return out;
}

const Reader& reader_of(TerrainFormat format) {
    return *std::ranges::find(kReaders, format, &Reader::format);
}

}  // namespace

TerrainFormat terrain_format_of(std::string_view bytes) {
    // "II" or "MM" for the order of bytes, then 42, or 43 for files beyond 4 GiB.
    using namespace std::string_view_literals;
    const bool is_tiff = bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
                         bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv);
    if (is_tiff) return TerrainFormat::GeoTiff;
    if (api::begins_as_ascii_grid(bytes)) return TerrainFormat::AsciiGrid;
    return TerrainFormat::Json;
}

std::optional<TerrainFormat> terrain_format_named(std::string_view media_type) {
    for (const Reader& reader : kReaders)
        if (std::ranges::find(reader.media_types, media_type) != reader.media_types.end())
            return reader.format;
    return std::nullopt;
}

api::Parsed<LoadedTerrain> load_terrain(std::string_view bytes, TerrainFormat format,
                                        const api::TerrainOptions& options,
                                        const api::ReadLimits& limits) {
    begin_stage(0.4);
    auto terrain = reader_of(format).read(bytes, options, limits);
    if (terrain) terrain = settled(*std::move(terrain), format, options, limits);
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
