// SPDX-License-Identifier: Apache-2.0
// The main job in one request: a terrain and polygons in, the mesh or the report out, nothing kept.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/form.hpp"
#include "api/formats/options_reader.hpp"
#include "api/media_type.hpp"
#include "api/responses.hpp"
#include "api/terrain_options.hpp"
#include "server/mesh_source.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"
#include "server/terrain_reading.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 3> kAnswerTypes{kJson, kGlb, kGltf};
constexpr std::string_view kTerrain = "terrain";
constexpr std::string_view kPolygons = "polygons";
constexpr std::string_view kOptions = "options";
constexpr const char* kForm = "multipart/form-data";

/// What is wrong with all of them, the first kind with a reason to be told.
struct FormFaults {
    api::FaultKind kind = api::FaultKind::Invalid;
    api::Faults faults;

    /// Faults at places of one part: its name stands in front of the pointer.
    void add(api::FaultKind of, std::string_view part, api::Faults more) {
        if (faults.empty()) kind = of;
        for (api::Fault& fault : more) {
            if (faults.size() >= api::kMaxFaults) return;
            // Options are at fault where they stand, though the polygons' reader judges them.
            const std::string own = "/" + std::string(kOptions);
            if (!fault.pointer.starts_with(own)) {
                fault.pointer = "/" + std::string(part) + fault.pointer;
            }
            faults.push_back(std::move(fault));
        }
    }
};

struct Form {
    const api::FormPart* terrain = nullptr;
    const api::FormPart* polygons = nullptr;
    const api::FormPart* options = nullptr;
};

Form form_of(const std::vector<api::FormPart>& parts, FormFaults& faults) {
    Form form;
    for (const api::FormPart& part : parts) {
        const api::FormPart** place = part.name == kTerrain    ? &form.terrain
                                      : part.name == kPolygons ? &form.polygons
                                      : part.name == kOptions  ? &form.options
                                                               : nullptr;
        if (place == nullptr || *place != nullptr) {
            faults.add(api::FaultKind::Invalid, part.name.substr(0, 64),
                       {{place == nullptr ? "PART_UNKNOWN" : "PART_REPEATED",
                         "The parts are terrain, polygons and options, each once.",
                         {}}});
            continue;
        }
        *place = &part;
    }
    for (const auto& [part, name] :
         {std::pair(form.terrain, kTerrain), {form.polygons, kPolygons}}) {
        if (part != nullptr) continue;
        faults.add(
            api::FaultKind::Invalid, name,
            {{"PART_MISSING",
              "There is no such part: with curl, -F '" + std::string(name) + "=@file;type=...'.",
              {}}});
    }
    return form;
}

/// What the part claims to be; programs that know no better say octet-stream, or nothing.
std::optional<TerrainFormat> format_of(const api::FormPart& part) {
    const bool is_unsaid = part.media_type.empty() || part.media_type == "application/octet-stream";
    return is_unsaid ? terrain_format_of(part.body) : terrain_format_named(part.media_type);
}

std::optional<LoadedTerrain> read_terrain(const api::ReadLimits& limits, const api::FormPart& part,
                                          const api::TerrainOptions& options, MemoryToBuild& memory,
                                          FormFaults& faults) {
    const auto format = format_of(part);
    if (!format) {
        faults.add(api::FaultKind::Invalid, kTerrain,
                   {{"PART_TYPE",
                     "A terrain is not read as " + part.media_type.substr(0, 64) +
                         ": give the part the type that POST /v1/sessions takes.",
                     {}}});
        return std::nullopt;
    }
    auto terrain = load_terrain(part.body, *format, options, limits,
                                [&memory](std::size_t bytes) { return memory.take(bytes); });
    if (terrain) return std::move(*terrain);
    faults.add(terrain.kind(), kTerrain, std::move(terrain.faults()));
    return std::nullopt;
}

struct Options {
    std::vector<api::NamedOption> polygons;
    api::MeshOptions mesh;
    api::TerrainOptions terrain;
};

/// The options of the polygons request, of the mesh and of the terrain in one object, by their
/// names.
Options read_options(const api::ReadLimits& limits, const api::FormPart* part, FormFaults& faults) {
    Options options;
    if (part == nullptr) return options;
    auto read = api::read_options(part->body, limits);
    if (!read) {
        faults.add(read.kind(), kOptions, std::move(read.faults()));
        return options;
    }
    const auto has = [](std::span<const std::string_view> names, const std::string& name) {
        return std::ranges::find(names, name) != names.end();
    };
    std::vector<api::NamedOption> mesh, terrain;
    for (auto& [name, value] : *read) {
        const std::string pointer = "/" + std::string(kOptions) + "/" + name;
        auto& list = has(api::mesh_option_names(), name)             ? mesh
                     : has(api::terrain_option_names_beside(), name) ? terrain
                                                                     : options.polygons;
        list.push_back({name, value, pointer});
    }
    auto of_terrain = api::parse_terrain_options(terrain);
    if (of_terrain) options.terrain = *of_terrain;
    if (!of_terrain) faults.add(of_terrain.kind(), kOptions, std::move(of_terrain.faults()));
    auto parsed = api::parse_mesh_options(mesh);
    if (parsed) options.mesh = *parsed;
    if (!parsed) faults.add(parsed.kind(), kOptions, std::move(parsed.faults()));
    // Judged once more with the polygons, which may bring options along; by then what is wrong here
    // has been told.
    auto judged = api::parse_polygon_options(options.polygons, api::OptionList::Part);
    if (!judged) {
        faults.add(judged.kind(), kOptions, std::move(judged.faults()));
        options.polygons.clear();
    }
    return options;
}

Response send(Services& services, const Request& request, const Session& session,
              const PolygonResult& result, std::size_t type, bool dry_run,
              api::MeshOptions options) {
    if (type == 0) {
        return ok(kJson, api::write_report({{},
                                            result.version,
                                            dry_run,
                                            result.polygon_ids,
                                            *result.report,
                                            session.facts().repairs,
                                            result.angles}));
    }
    if (!result.mesh) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "There is no memory for a copy of the mesh: ask for the report, or try "
                      "again later.");
    }
    MeshGround ground{*result.mesh, result.version, {}};
    if (options.regions) ground = ground_now(session, true);
    auto found = source_of(std::move(ground), options, session.facts().unit,
                           {services.limits_of(request.asker).max_crossings,
                            deadline(services.limits_of(request.asker), services.stopping)});
    if (auto* no = std::get_if<NoSource>(&found)) {
        if (const auto* errors = std::get_if<core::Errors>(no))
            return refuse_question(request, *errors);
        api::Fault fault = std::get<api::Fault>(std::move(*no));
        fault.parameter.clear();
        fault.pointer = "/" + std::string(kOptions) + "/bbox";
        return refuse(request, api::problem_of_faults(api::FaultKind::Invalid, {std::move(fault)}));
    }
    const auto& source = std::get<MeshSource>(found);
    options.gltf.unit_to_metre = api::metres_per(session.facts().unit);
    options.gltf.crs = session.facts().crs;
    return gltf_response(services.metrics, request, source.mesh, options.gltf,
                         {kAnswerTypes[type], source.regions ? &*source.regions : nullptr});
}

/// The regions of a mesh that is not kept are nowhere to be found.
std::optional<Response> refusal_of_dry_regions(const Request& request, bool dry_run,
                                               const api::MeshOptions& options) {
    if (!dry_run || !options.regions) return std::nullopt;
    return refuse(
        request, api::problem_of_faults(
                     api::FaultKind::Invalid,
                     {{"CONTRADICTION", "A dry run makes no regions: leave regions or dry_run out.",
                       "/" + std::string(kOptions) + "/regions"}}));
}

/// Everything has been read.
Response integrate(Services& services, const Request& request, LoadedTerrain terrain,
                   PolygonWork work, std::size_t type, const api::MeshOptions& options) {
    if (auto refusal = refusal_of_dry_regions(request, work.edit.dry_run, options)) return *refusal;
    if (work.edit.want_angles && type != 0) return refuse_angles_of_mesh(request);
    const std::size_t mesh_bytes = terrain.tin.memory_bytes();
    const auto memory = require_memory(services, request,
                                       mesh_bytes + (type != 0 ? bytes_to_encode(mesh_bytes) : 0));
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    work.edit.want_mesh = type != 0;
    begin_stage(0.8);
    set_budgets(work.edit, services.limits_of(request.asker), services.stopping);
    const bool dry_run = work.edit.dry_run;
    Session session({{},
                     {},
                     terrain.about.name,
                     terrain.about.crs,
                     terrain.about.unit,
                     std::move(terrain.about.repairs),
                     std::move(terrain.about.notes)},
                    std::move(terrain.tin));
    const Stopwatch watch;
    const auto outcome = session.integrate(std::move(work.edit));
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        FormFaults faults;
        faults.add(api::FaultKind::Invalid, kPolygons, faults_of(*errors, work.shapes));
        return refuse(request, api::problem_of_errors(*errors, std::move(faults.faults)));
    }
    const auto& result = std::get<PolygonResult>(outcome);
    services.metrics.edited(*result.report, watch.seconds(), dry_run);
    begin_stage(1.0);
    return send(services, request, session, result, type, dry_run, options);
}

}  // namespace

Response integrate_once(Services& services, const Request& request, const PathArguments&) {
    const std::string content_type(request.header("content-type").value_or(""));
    const std::string type = api::media_type_of(content_type);
    if (type != kForm) {
        return refuse_media_type(request, type, "a form", kForm,
                                 "-F 'terrain=@x.tif;type=image/tiff' and -F "
                                 "'polygons=@y.geojson' in place of -d");
    }
    const auto accepted = require_media_type(request, kAnswerTypes);
    if (const auto* refusal = std::get_if<Response>(&accepted)) return *refusal;
    auto parts = api::read_form(request.body, content_type);
    if (!parts) {
        return refuse(request, api::problem_of_faults(parts.kind(), std::move(parts.faults())));
    }
    FormFaults faults;
    const Form form = form_of(*parts, faults);
    const api::ReadLimits limits = services.read_limits(request.asker);
    const Options options = read_options(limits, form.options, faults);
    std::optional<LoadedTerrain> terrain;
    std::optional<MemoryToBuild> memory(std::in_place, services, request);
    if (form.terrain != nullptr)
        terrain = read_terrain(limits, *form.terrain, options.terrain, *memory, faults);
    if (auto refusal = memory->refusal()) return *std::move(refusal);
    std::optional<PolygonWork> work;
    if (form.polygons != nullptr) {
        begin_stage(0.1);
        auto read = read_polygon_work(form.polygons->body, options.polygons, limits);
        if (read) work = std::move(*read);
        if (!read) faults.add(read.kind(), kPolygons, std::move(read.faults()));
    }
    if (terrain && work) {
        auto misplaced = bring_into(*work, terrain->about.crs);
        if (!misplaced.empty())
            faults.add(api::FaultKind::Invalid, kPolygons, std::move(misplaced));
    }
    if (!faults.faults.empty()) {
        return refuse(request, api::problem_of_faults(faults.kind, std::move(faults.faults)));
    }
    memory.reset();  // from here on the mesh is counted
    return integrate(services, request, *std::move(terrain), *std::move(work),
                     std::get<0>(accepted), options.mesh)
        .with("Vary", "Accept");
}

}  // namespace tinsmith::server
