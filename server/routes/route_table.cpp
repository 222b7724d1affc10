// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.hpp"

#include "api/requests.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/idempotency.hpp"

namespace tinsmith::server {

namespace {

using Function = Response (*)(Services&, const Request&, const PathArguments&);

}  // namespace

std::vector<Route> make_routes(Services& services) {
    const auto to = [&services](Function function) -> Handler {
        return [&services, function](const Request& request, const PathArguments& arguments) {
            return function(services, request, arguments);
        };
    };
    // For every POST that changes something: a retry with the same Idempotency-Key is not done
    // again.
    const auto change = [&services, to](Function function) {
        return keyed(services, to(function));
    };
    const auto mesh = api::mesh_option_names();
    const auto polygons = api::polygon_option_names();
    return {
        {"GET", "/", {}, to(get_welcome)},
        {"GET", "/healthz", {}, to(get_health)},
        {"GET", "/v1/limits", {}, to(get_limits)},
        {"GET", "/v1/sessions", {}, to(list_sessions)},
        {"POST", "/v1/sessions", {}, change(create_session)},
        {"GET", "/v1/sessions/{id}", {}, to(get_session)},
        {"PUT", "/v1/sessions/{id}", {}, to(put_session)},
        {"DELETE", "/v1/sessions/{id}", {}, to(delete_session)},
        {"POST", "/v1/sessions/{id}/fork", {}, change(fork_session)},
        {"POST", "/v1/sessions/{id}/polygons", polygons, change(integrate_polygons)},
        {"GET", "/v1/sessions/{id}/polygons", {}, to(list_polygons)},
        {"GET", "/v1/sessions/{id}/polygons/{pid}", {}, to(get_polygon)},
        {"GET", "/v1/sessions/{id}/mesh", mesh, to(get_mesh)},
        {"GET", "/v1/sessions/{id}/mesh.glb", mesh, to(get_mesh_glb)},
        {"GET", "/v1/sessions/{id}/mesh.json", {}, to(get_mesh_json)},
    };
}

}  // namespace tinsmith::server
