// SPDX-License-Identifier: Apache-2.0
#include "server/terrain_reading.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "api/formats/ascii_grid.hpp"
#include "api/formats/csv.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/glb_reader.hpp"
#include "api/formats/grid_mesh.hpp"
#include "api/formats/landxml_reader.hpp"
#include "api/formats/obj_reader.hpp"
#include "api/formats/points_mesh.hpp"
#include "api/formats/terrain_json.hpp"
#include "api/side_by_side.hpp"
#include "api/terrain_system.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/repair.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

/// The fault in the body's own places.
api::Fault fault_of(const core::Error& error, TerrainFormat format, const api::Terrain& about) {
    api::Fault fault{std::string(core::code_name(error.code)), error.detail, {}};
    if (error.place.triangle && about.triangle_place)
        fault.detail += " (" + about.triangle_place(*error.place.triangle) + ")";
    else if (error.place.vertex && about.vertex_place)
        fault.detail += " (" + about.vertex_place(*error.place.vertex) + ")";
    // Of points and grids the triangles are not the caller's.
    const bool is_json = format == TerrainFormat::Json && !about.triangles_are_made;
    if (error.place.triangle) {
        fault.index = *error.place.triangle;
        if (is_json)
            fault.pointer = about.mesh_pointer + "/triangles/" + std::to_string(*fault.index);
    } else if (error.place.vertex) {
        fault.index = *error.place.vertex;
        if (is_json)
            fault.pointer = about.mesh_pointer + "/vertices/" + std::to_string(*fault.index);
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
constexpr std::string_view kCsvTypes[] = {"text/csv"};
constexpr std::string_view kGlbTypes[] = {"model/gltf-binary", "model/gltf+json"};
constexpr std::string_view kObjTypes[] = {"model/obj"};
constexpr std::string_view kLandXmlTypes[] = {"application/xml", "text/xml",
                                              "application/landxml+xml"};

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
    {TerrainFormat::Csv, kCsvTypes,
     [](std::string_view bytes, const api::TerrainOptions& options, const api::ReadLimits& limits) {
         return api::read_csv(bytes, options, limits);
     }},
    {TerrainFormat::Glb, kGlbTypes,
     [](std::string_view bytes, const api::TerrainOptions&, const api::ReadLimits& limits) {
         return api::read_glb(bytes, limits);
     }},
    {TerrainFormat::Obj, kObjTypes,
     [](std::string_view bytes, const api::TerrainOptions&, const api::ReadLimits& limits) {
         return api::read_obj(bytes, limits);
     }},
    {TerrainFormat::LandXml, kLandXmlTypes,
     [](std::string_view bytes, const api::TerrainOptions&, const api::ReadLimits& limits) {
         return api::read_landxml(bytes, limits);
     }},
};

/// Only JSON has members that faults can point to.
api::Parsed<api::Terrain> settled(api::Terrain terrain, TerrainFormat format,
                                  const api::TerrainOptions& options,
                                  const api::ReadLimits& limits) {
    if (format == TerrainFormat::Glb) api::bring_from_metres(terrain, options);
    auto out = api::in_its_system(std::move(terrain), options, limits);
    if (out || format == TerrainFormat::Json) return out;
    for (api::Fault& fault : out.faults())
        fault.pointer.clear();
    return out;
}

const Reader& reader_of(TerrainFormat format) {
    return *std::ranges::find(kReaders, format, &Reader::format);
}

/// Without the mark of UTF-8 that some programs begin a text with.
std::string_view without_mark(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    return bytes;
}

/// The first word of the first line that is neither empty nor a comment.
std::string_view first_word(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
        if (begin == bytes.npos) return {};
        bytes.remove_prefix(begin);
        if (bytes.front() != '#') return bytes.substr(0, bytes.find_first_of(" \t\r\n"));
        bytes.remove_prefix(std::min(bytes.find('\n'), bytes.size()));
    }
    return {};
}

bool is_obj(std::string_view bytes) {
    constexpr std::string_view kWords[] = {"v", "vt", "vn", "o", "g", "s", "mtllib", "usemtl"};
    return std::ranges::find(kWords, first_word(bytes)) != std::end(kWords);
}

/// A glTF as JSON, by its first member: none of them is a member of our own JSON.
bool is_gltf(std::string_view bytes) {
    constexpr std::string_view kNames[] = {"accessors",   "animations",     "asset",
                                           "bufferViews", "buffers",        "cameras",
                                           "extensions",  "extensionsUsed", "extensionsRequired",
                                           "extras",      "images",         "materials",
                                           "meshes",      "nodes",          "samplers",
                                           "scene",       "scenes",         "skins",
                                           "textures"};
    constexpr std::string_view kSpaces = " \t\r\n";
    bytes.remove_prefix(std::min(bytes.find_first_not_of(kSpaces), bytes.size()));
    if (!bytes.starts_with('{')) return false;
    bytes.remove_prefix(1);
    bytes.remove_prefix(std::min(bytes.find_first_not_of(kSpaces), bytes.size()));
    if (!bytes.starts_with('"')) return false;
    const std::string_view name = bytes.substr(1, bytes.find('"', 1) - 1);
    return std::ranges::find(kNames, name) != std::end(kNames);
}

bool is_xml(std::string_view bytes) {
    return first_word(bytes).starts_with('<');
}

/// Repairs, and what `vertices` says the vertices were called, by the numbers that points had.
void name_as_points(api::Terrain& terrain, std::vector<std::uint32_t>& vertices) {
    const std::vector<std::uint32_t>& names = terrain.vertex_names;
    if (vertices.empty()) {
        vertices = names;
    } else {
        for (std::uint32_t& vertex : vertices)
            vertex = names[vertex];
    }
    if (!terrain.repairs) return;
    for (core::Repair& repair : *terrain.repairs) {
        if (repair.kind != core::RepairKind::VerticesWelded &&
            repair.kind != core::RepairKind::VerticesUnused)
            continue;
        for (std::size_t& index : repair.indices)
            index = names[index];
    }
}

/// About what triangulating, mending and building take beside what has been read, at most:
/// measured with bodies of every format (tests/attack/memory_test.cpp).
std::size_t bytes_to_build(const api::Terrain& terrain) {
    constexpr std::size_t kOfVertex = 64;
    constexpr std::size_t kOfTriangle = 48;
    const std::size_t vertices =
        terrain.grid ? terrain.grid->elevations.size() : terrain.mesh.vertices.size();
    const bool are_to_come = terrain.points || terrain.grid;
    const std::size_t triangles = are_to_come ? 2 * vertices : terrain.mesh.triangles.size();
    return kOfVertex * vertices + kOfTriangle * triangles;
}

/// What the readers said of the mesh is not needed any more.
LoadedTerrain loaded(api::Terrain terrain, core::Tin tin) {
    terrain.mesh = {};
    terrain.grid.reset();
    terrain.vertex_names = {};
    terrain.vertex_place = {};
    terrain.triangle_place = {};
    return {std::move(terrain), std::move(tin)};
}

/// What the options ask for is mended; then the mesh is built.
api::Parsed<LoadedTerrain> built(api::Terrain terrain, TerrainFormat format,
                                 const api::TerrainOptions& options) {
    core::Repaired repaired;
    if (options.repair) {
        repaired = core::repair_mesh(terrain.mesh, options.weld);
        terrain.repairs = std::move(repaired.repairs);
        if (terrain.mesh.triangles.empty()) {
            return {api::FaultKind::Invalid,
                    api::Fault{"NOTHING_LEFT",
                               "All triangles are flat in plan, such as upright ones, or repeated: "
                               "nothing is left after the repair. A terrain has z up.",
                               {}}};
        }
    }
    if (!terrain.vertex_names.empty()) name_as_points(terrain, repaired.vertices);
    auto tin = core::build_tin(terrain.mesh, {repaired.vertices, repaired.triangles});
    if (told_to_stop()) return {api::FaultKind::Stopped, api::reading_stopped()};
    if (!tin) {
        api::Faults faults;
        auto kind = api::FaultKind::Invalid;
        for (const core::Error& error : tin.errors()) {
            if (error.code == core::ErrorCode::MeshTooLarge) kind = api::FaultKind::TooLarge;
            faults.push_back(fault_of(error, format, terrain));
        }
        return {kind, std::move(faults)};
    }
    return loaded(std::move(terrain), std::move(*tin));
}

}  // namespace

TerrainFormat terrain_format_of(std::string_view bytes) {
    // "II" or "MM" for the order of bytes, then 42, or 43 for files beyond 4 GiB.
    using namespace std::string_view_literals;
    const bool is_tiff = bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
                         bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv);
    if (is_tiff) return TerrainFormat::GeoTiff;
    bytes = without_mark(bytes);
    if (bytes.starts_with("glTF") || is_gltf(bytes)) return TerrainFormat::Glb;
    if (first_word(bytes).starts_with('{')) return TerrainFormat::Json;
    if (is_xml(bytes)) return TerrainFormat::LandXml;
    if (api::begins_as_ascii_grid(bytes)) return TerrainFormat::AsciiGrid;
    if (api::looks_like_csv(bytes)) return TerrainFormat::Csv;
    return is_obj(bytes) ? TerrainFormat::Obj : TerrainFormat::Json;
}

std::optional<TerrainFormat> terrain_format_named(std::string_view media_type) {
    for (const Reader& reader : kReaders)
        if (std::ranges::find(reader.media_types, media_type) != reader.media_types.end())
            return reader.format;
    return std::nullopt;
}

api::Parsed<LoadedTerrain> load_terrain(std::string_view bytes, TerrainFormat format,
                                        const api::TerrainOptions& options,
                                        const api::ReadLimits& limits, const MayTake& may_take) {
    begin_stage(0.4);
    // Faults of JSON count its bytes from the first, and its reader knows the mark.
    if (format != TerrainFormat::Json) bytes = without_mark(bytes);
    auto terrain = reader_of(format).read(bytes, options, limits);
    if (terrain) terrain = settled(*std::move(terrain), format, options, limits);
    if (terrain && may_take && !may_take(bytes_to_build(*terrain)))
        return {api::FaultKind::Stopped, api::reading_stopped()};
    if (terrain) terrain = api::triangulated(*std::move(terrain), limits);
    if (!terrain) return {terrain.kind(), std::move(terrain.faults())};
    begin_stage(0.6);
    if (terrain->grid && !options.repair) {
        auto tin = api::tin_of_grid(*terrain->grid, limits, api::side_by_side);
        if (told_to_stop()) return {api::FaultKind::Stopped, api::reading_stopped()};
        if (tin) return loaded(std::move(*terrain), std::move(*tin));
    }
    terrain = api::meshed(std::move(terrain), limits);
    if (!terrain) return {terrain.kind(), std::move(terrain.faults())};
    return built(std::move(*terrain), format, options);
}

}  // namespace tinsmith::server
