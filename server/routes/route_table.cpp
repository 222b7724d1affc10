// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_table.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "api/requests.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/idempotency.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 1> kRemoval{"cascade"};
constexpr std::array<std::string_view, 1> kEdit{"dry_run"};
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
    // For every POST that changes something: a retry with the same Idempotency-Key is not done
    // again.
    const auto change = [&services, to](Function function) {
        return keyed(services, to(function));
    };
    const auto json = [to](Function function) { return as_json(to(function)); };
    const auto mesh = api::mesh_option_names();
    const auto polygons = api::polygon_option_names();
    return {
        {"GET", "/", {}, to(get_welcome)},
        {"GET", "/healthz", {}, to(get_health)},
        {"GET", "/v1/limits", {}, json(get_limits)},
        {"GET", "/v1/sessions", kPageParameters, json(list_sessions)},
        {"POST", "/v1/sessions", {}, as_json(change(create_session))},
        {"GET", "/v1/sessions/{id}", {}, json(get_session)},
        {"PUT", "/v1/sessions/{id}", {}, json(put_session)},
        {"DELETE", "/v1/sessions/{id}", {}, to(delete_session)},
        {"POST", "/v1/sessions/{id}/fork", {}, as_json(change(fork_session))},
        {"POST", "/v1/sessions/{id}/polygons", polygons, change(integrate_polygons)},
        {"GET", "/v1/sessions/{id}/polygons", kPageParameters, to(list_polygons)},
        {"GET", "/v1/sessions/{id}/polygons/{pid}", {}, to(get_polygon)},
        {"DELETE", "/v1/sessions/{id}/polygons/{pid}", kRemoval, to(delete_polygon)},
        {"POST", "/v1/sessions/{id}/edits", kEdit, change(edit_polygon)},
        {"POST", "/v1/sessions/{id}/undo", {}, change(undo_edit)},
        {"POST", "/v1/sessions/{id}/redo", {}, change(redo_edit)},
        {"GET", "/v1/sessions/{id}/history", {}, json(get_history)},
        {"GET", "/v1/sessions/{id}/history/{version}", {}, json(get_change)},
        {"GET", "/v1/sessions/{id}/mesh", mesh_parameters(), to(get_mesh)},
        {"GET", "/v1/sessions/{id}/mesh.glb", mesh, to(get_mesh_glb)},
        {"GET", "/v1/sessions/{id}/mesh.json", {}, to(get_mesh_json)},
        {"GET", "/v1/sessions/{id}/elevation", kPosition, json(get_elevation)},
        {"POST", "/v1/sessions/{id}/elevation", {}, json(ask_elevations)},
        {"POST", "/v1/sessions/{id}/profile", {}, json(ask_profile)},
        {"POST", "/v1/sessions/{id}/volume", {}, json(ask_volume)},
    };
}

}  // namespace tinsmith::server
