// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "api/requests.hpp"
#include "api/terrain_options.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/idempotency.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/respond_async.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 1> kRemoval{"cascade"};
constexpr std::array<std::string_view, 2> kJsonMesh{"version", "bbox"};
constexpr std::array<std::string_view, 3> kExchangeMesh{"version", "bbox", "constraints"};
constexpr std::array<std::string_view, 1> kEdit{"dry_run"};
constexpr std::array<std::string_view, 3> kPosition{"x", "y", "crs"};
constexpr std::array<std::string_view, 1> kCrs{"crs"};

using Function = Response (*)(Services&, const Request&, const PathArguments&);

/// The mesh itself takes one parameter more than its files.
std::span<const std::string_view> mesh_parameters() {
    static const std::vector<std::string_view> kNames = [] {
        const auto options = api::mesh_option_names();
        std::vector<std::string_view> names(options.begin(), options.end());
        names.emplace_back("since");
        return names;
    }();
    return kNames;
}

/// What an edit takes, and how its mesh is to be written where that is the answer.
std::vector<std::string_view> with_gltf_options(std::span<const std::string_view> own) {
    const auto gltf = api::gltf_option_names();
    std::vector<std::string_view> names(own.begin(), own.end());
    names.insert(names.end(), gltf.begin(), gltf.end());
    return names;
}

/// A handler that answers in JSON whatever is asked: 406 where that is not acceptable.
Handler as_json(Handler handler) {
    return [handler = std::move(handler)](const Request& request, const PathArguments& arguments) {
        static constexpr std::array<std::string_view, 1> kOffer{kJson};
        const auto type = require_media_type(request, kOffer);
        if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
        return handler(request, arguments);
    };
}

}  // namespace

std::vector<Route> make_routes(Services& services) {
    const auto to = [&services](Function function) -> Handler {
        return [&services, function](const Request& request, const PathArguments& arguments) {
            return function(services, request, arguments);
        };
    };
    // For every POST that changes something, and what makes a version: a retry with the same
    // Idempotency-Key is not done again, and who prefers so gets a job at once.
    const auto change = [&services, to](Function function) {
        return keyed(services, deferrable(services, to(function)));
    };
    const auto long_json = [&services, to](Function function) {
        return as_json(deferrable(services, to(function)));
    };
    // Makes the session that its path names.
    const auto long_making = [&services, to](Function function) {
        return as_json(deferrable(services, to(function), Names::NewSession));
    };
    const auto json = [to](Function function) { return as_json(to(function)); };
    const auto terrain = api::terrain_option_names();
    const auto mesh = api::mesh_option_names();
    static const auto kPolygons = with_gltf_options(api::polygon_option_names());
    static const auto kEditOrMesh = with_gltf_options(kEdit);
    std::vector<Route> routes{
        {"GET", "/", {}, to(get_page)},
        {"GET", "/healthz", {}, to(get_health)},
        {"GET", "/readyz", {}, to(get_ready)},
        {"GET", "/metrics", {}, to(get_metrics)},
        {"GET", "/openapi.json", {}, to(get_description)},
        {"GET", "/docs", {}, to(get_docs)},
        {"GET", "/docs/{file}", {}, to(get_docs_file)},
        {"GET", "/v1/limits", {}, json(get_limits)},
        {"POST", "/v1/integrate", {}, deferrable(services, to(integrate_once))},
        {"GET", "/v1/jobs", kPageParameters, json(list_jobs)},
        {"GET", "/v1/jobs/{id}", {}, json(get_job)},
        {"DELETE", "/v1/jobs/{id}", {}, json(delete_job)},
        {"GET", "/v1/jobs/{id}/result", {}, to(get_job_result)},
        {"GET", "/v1/sessions", kPageParameters, json(list_sessions)},
        {"POST", "/v1/sessions", terrain, as_json(change(create_session))},
        {"GET", "/v1/sessions/{id}", {}, json(get_session)},
        {"PUT", "/v1/sessions/{id}", terrain, long_making(put_session)},
        {"DELETE", "/v1/sessions/{id}", {}, to(delete_session)},
        {"POST", "/v1/sessions/{id}/fork", {}, as_json(change(fork_session))},
        {"POST", "/v1/sessions/{id}/polygons", kPolygons, change(integrate_polygons)},
        {"GET", "/v1/sessions/{id}/polygons", kPageParameters, to(list_polygons)},
        {"GET", "/v1/sessions/{id}/polygons/{pid}", {}, to(get_polygon)},
        {"DELETE", "/v1/sessions/{id}/polygons/{pid}", kRemoval, to(delete_polygon)},
        {"GET", "/v1/sessions/{id}/regions", kPageParameters, to(list_regions)},
        {"GET", "/v1/sessions/{id}/regions/{pid}", {}, to(get_region)},
        {"GET", "/v1/sessions/{id}/constraints", kPageParameters, to(list_constraints)},
        {"PUT", "/v1/sessions/{id}/locks", kLockParameters, change(put_locks)},
        {"DELETE", "/v1/sessions/{id}/locks", kLockParameters, change(delete_locks)},
        {"GET", "/v1/sessions/{id}/locks", kPageParameters, to(get_locks)},
        {"POST", "/v1/sessions/{id}/edits", kEditOrMesh, change(edit_polygon)},
        {"POST", "/v1/sessions/{id}/undo", {}, change(undo_edit)},
        {"POST", "/v1/sessions/{id}/redo", {}, change(redo_edit)},
        {"GET", "/v1/sessions/{id}/history", kPageParameters, json(get_history)},
        {"GET", "/v1/sessions/{id}/history/{version}", {}, json(get_change)},
        {"GET", "/v1/sessions/{id}/mesh", mesh_parameters(), to(get_mesh)},
        {"GET", "/v1/sessions/{id}/mesh.glb", mesh, to(get_mesh_glb)},
        {"GET", "/v1/sessions/{id}/mesh.gltf", mesh, to(get_mesh_gltf)},
        {"GET", "/v1/sessions/{id}/mesh.json", kJsonMesh, to(get_mesh_json)},
        {"GET", "/v1/sessions/{id}/mesh.obj", kExchangeMesh, to(get_mesh_obj)},
        {"GET", "/v1/sessions/{id}/mesh.xml", kExchangeMesh, to(get_mesh_landxml)},
        {"GET", "/v1/sessions/{id}/elevation", kPosition, json(get_elevation)},
        {"POST", "/v1/sessions/{id}/elevation", kCrs, long_json(ask_elevations)},
        {"POST", "/v1/sessions/{id}/profile", kCrs, long_json(ask_profile)},
        {"POST", "/v1/sessions/{id}/volume", {}, long_json(ask_volume)},
    };
    for (Route& route : routes) {
        if (route.pattern.starts_with("/v1/") && route.pattern != "/v1/limits")
            route.handler = once_started(services, std::move(route.handler));
    }
    return routes;
}

}  // namespace tinsmith::server
