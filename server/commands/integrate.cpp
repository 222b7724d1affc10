// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <filesystem>
#include <optional>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/gltf.hpp"
#include "api/responses.hpp"
#include "api/side_by_side.hpp"
#include "api/terrain_options.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/commands/progress.hpp"
#include "server/file_io.hpp"
#include "server/mesh_source.hpp"
#include "server/polygon_reading.hpp"
#include "server/services.hpp"
#include "server/terrain_reading.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

/// A command line is its owner's own work: the limits of a service do not apply, those of ids do.
Limits command_limits() {
    Limits limits;
    limits.max_vertices = 400'000'000;
    limits.max_triangles = core::kMaxTriangles;
    limits.max_crossings = UINT64_MAX;
    limits.max_edit_seconds = 1e9;
    return limits;
}

std::optional<LoadedTerrain> read_terrain(const std::string& path,
                                          const api::TerrainOptions& options,
                                          const Services& services, ProgressBar& bar) {
    bar.name("reading the terrain");
    std::string error;
    const auto bytes = read_file(path, error);
    if (!bytes) {
        bar.clear();
        complain(error);
        return std::nullopt;
    }
    auto terrain = load_terrain(*bytes, terrain_format_of(*bytes), options, services.read_limits());
    if (!terrain) {
        bar.clear();
        complain(path, terrain.faults());
        return std::nullopt;
    }
    bar.clear();
    tell_of(path, terrain->about);
    return std::move(*terrain);
}

std::optional<PolygonWork> read_polygons(const IntegrateConfig& config, const Services& services,
                                         const std::string& terrain_crs, ProgressBar& bar) {
    bar.name("reading the polygons");
    begin_stage(0.1);
    std::string error;
    const auto bytes = read_file(config.polygons, error);
    if (!bytes) {
        bar.clear();
        complain(error);
        return std::nullopt;
    }
    auto work = read_polygon_work(*bytes, config.polygon_options, services.read_limits());
    if (!work) {
        bar.clear();
        complain(config.polygons, work.faults());
        return std::nullopt;
    }
    if (const auto faults = bring_into(*work, terrain_crs); !faults.empty()) {
        bar.clear();
        complain(config.polygons, faults);
        return std::nullopt;
    }
    bar.name("integrating");
    begin_stage(0.8);
    work->edit.want_mesh = true;
    set_budgets(work->edit, services.limits, services.stopping);
    return std::move(*work);
}

/// An empty path writes nothing.
bool write_output(const std::string& path, std::string_view content) {
    if (path.empty()) return true;
    const std::string error = write_file_atomically(path, content);
    if (!error.empty()) complain(error);
    return error.empty();
}

int write_results(const IntegrateConfig& config, const Session& session,
                  const PolygonResult& result, bool dry_run, api::MeshOptions options,
                  ProgressBar& bar) {
    if (!result.mesh) {
        bar.clear();
        complain("not enough memory for a copy of the mesh");
        return kExitRefused;
    }
    options.gltf.unit_to_metre = api::metres_per(session.facts().unit);
    options.gltf.crs = session.facts().crs;
    if (options.regions && dry_run) {
        bar.clear();
        complain("a dry run makes no regions: leave --regions or --dry-run out");
        return kExitUsage;
    }
    MeshGround ground{*result.mesh, result.version, {}};
    if (options.regions) ground = ground_now(session, true);
    const auto found = source_of(std::move(ground), options, session.facts().unit, {});
    if (const auto* no = std::get_if<NoSource>(&found)) {
        bar.clear();
        const auto* fault = std::get_if<api::Fault>(no);
        complain(fault != nullptr ? fault->detail : std::get<core::Errors>(*no).front().detail);
        return kExitRefused;
    }
    const auto& source = std::get<MeshSource>(found);
    const auto written = api::write_glb(
        source.mesh, options.gltf, source.regions ? &*source.regions : nullptr, api::side_by_side);
    bar.clear();
    if (const auto* error = std::get_if<api::EncodeError>(&written)) {
        complain(config.output + ": " + error->detail);
        return kExitRefused;
    }
    const std::string report =
        api::write_report({session.facts().name, result.version, dry_run, result.polygon_ids,
                           *result.report, session.facts().repairs, result.angles});
    const bool done = write_output(config.output, std::get<api::GltfResult>(written).bytes) &&
                      write_output(config.report, report);
    return done ? kExitOk : kExitRefused;
}

}  // namespace

int run_integrate(const IntegrateConfig& config) {
    const Services services(command_limits());
    auto mesh_options = api::parse_mesh_options(config.mesh_options);
    if (!mesh_options) complain("options", mesh_options.faults());
    // Judged once more with the polygons, which may bring options along; by then it is late.
    const auto polygon_options =
        api::parse_polygon_options(config.polygon_options, api::OptionList::Part);
    if (!polygon_options) complain("options", polygon_options.faults());
    const auto terrain_options = api::parse_terrain_options(config.terrain_options);
    if (!terrain_options) complain("options", terrain_options.faults());
    if (!mesh_options || !polygon_options || !terrain_options) return kExitUsage;
    if (config.output == config.report) {
        complain("--output and --report are one file, " + config.output + ": name two");
        return kExitUsage;
    }
    ProgressBar bar;
    Work watched([&bar](double done) { bar.show(done); });
    const WorkScope scope(watched);
    auto terrain = read_terrain(config.terrain, *terrain_options, services, bar);
    if (!terrain) return kExitRefused;
    auto work = read_polygons(config, services, terrain->about.crs, bar);
    if (!work) return kExitRefused;

    const std::string name = std::filesystem::path(config.terrain).stem().string();
    Session session(
        {name, "0", name, terrain->about.crs, terrain->about.unit, terrain->about.repairs},
        std::move(terrain->tin));
    const bool dry_run = work->edit.dry_run;
    const auto outcome = session.integrate(std::move(work->edit));
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        bar.clear();
        complain(config.polygons, faults_of(*errors, work->shapes));
        return kExitRefused;
    }
    bar.name("writing");
    begin_stage(1.0);
    const auto& result = std::get<PolygonResult>(outcome);
    return write_results(config, session, result, dry_run, *mesh_options, bar);
}

}  // namespace tinsmith::server
