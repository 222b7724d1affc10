// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.hpp"

#include <array>
#include <string_view>

#include "api/requests.hpp"
#include "server/routes/handlers.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 1> kRemoval{"cascade"};
constexpr std::array<std::string_view, 2> kPosition{"x", "y"};

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

}  // namespace

std::vector<Route> make_routes(Services& services) {
    const auto to = [&services](Function function) -> Handler {
        return [&services, function](const Request& request, const PathArguments& arguments) {
            return function(services, request, arguments);
        };
    };
    const auto mesh = api::mesh_option_names();
    const auto polygons = api::polygon_option_names();
    return {
        {"GET", "/", {}, to(get_welcome)},
        {"GET", "/healthz", {}, to(get_health)},
        {"GET", "/v1/limits", {}, to(get_limits)},
        {"GET", "/v1/sessions", {}, to(list_sessions)},
        {"POST", "/v1/sessions", {}, to(create_session)},
        {"GET", "/v1/sessions/{id}", {}, to(get_session)},
        {"PUT", "/v1/sessions/{id}", {}, to(put_session)},
        {"DELETE", "/v1/sessions/{id}", {}, to(delete_session)},
        {"POST", "/v1/sessions/{id}/fork", {}, to(fork_session)},
        {"POST", "/v1/sessions/{id}/polygons", polygons, to(integrate_polygons)},
        {"GET", "/v1/sessions/{id}/polygons", {}, to(list_polygons)},
        {"GET", "/v1/sessions/{id}/polygons/{pid}", {}, to(get_polygon)},
        {"DELETE", "/v1/sessions/{id}/polygons/{pid}", kRemoval, to(delete_polygon)},
        {"POST", "/v1/sessions/{id}/undo", {}, to(undo_edit)},
        {"POST", "/v1/sessions/{id}/redo", {}, to(redo_edit)},
        {"GET", "/v1/sessions/{id}/history", {}, to(get_history)},
        {"GET", "/v1/sessions/{id}/history/{version}", {}, to(get_change)},
        {"GET", "/v1/sessions/{id}/mesh", mesh_parameters(), to(get_mesh)},
        {"GET", "/v1/sessions/{id}/mesh.glb", mesh, to(get_mesh_glb)},
        {"GET", "/v1/sessions/{id}/mesh.json", {}, to(get_mesh_json)},
        {"GET", "/v1/sessions/{id}/elevation", kPosition, to(get_elevation)},
        {"POST", "/v1/sessions/{id}/elevation", {}, to(ask_elevations)},
        {"POST", "/v1/sessions/{id}/profile", {}, to(ask_profile)},
        {"POST", "/v1/sessions/{id}/volume", {}, to(ask_volume)},
    };
}

}  // namespace tinsmith::server
