// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <utility>

#include "api/media_type.hpp"
#include "api/responses.hpp"
#include "api/terrain_options.hpp"
#include "server/heap.hpp"
#include "server/random_id.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/terrain_reading.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "session";
constexpr std::string_view kTerrainTypes =
    "application/json (mesh, points or grid), image/tiff (GeoTIFF elevations), text/plain (ESRI "
    "ASCII grid), text/csv (x,y,z), model/gltf-binary, model/gltf+json, model/obj, application/xml "
    "(LandXML)";

/// The format by Content-Type, or 415 saying what curl should have been told.
Step<TerrainFormat> require_terrain_format(const Request& request) {
    const std::string type = api::media_type_of(request.header("content-type").value_or(""));
    if (const auto format = terrain_format_named(type)) return *format;
    return refuse_media_type(request, type, "a terrain", kTerrainTypes,
                             "-H 'Content-Type: application/json' or "
                             "-H 'Content-Type: image/tiff'");
}

Response refuse_session(const Request& request, const Limits& limits, StoreRefusal why) {
    const KeyQuotas& quotas = request.asker.quotas;
    if (why == StoreRefusal::NoMemoryOfKey) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "The sessions of this key would pass its quota max_memory_bytes of " +
                          std::to_string(quotas.max_memory_bytes.value_or(0)) +
                          ". DELETE those that are not needed.");
    }
    if (why == StoreRefusal::TooManyOfKey) {
        return refuse(request, api::ProblemType::TooManySessions,
                      "The quota max_sessions of this key, " +
                          std::to_string(quotas.max_sessions.value_or(0)) +
                          ", is reached. DELETE sessions that are not needed.");
    }
    if (why == StoreRefusal::TooLarge) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "The session would hold more than the limit max_session_bytes of " +
                          std::to_string(limits.max_session_bytes) +
                          ". Divide the terrain, or send fewer points.");
    }
    if (why == StoreRefusal::NoMemory) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "All meshes together would pass the limit max_memory_bytes of " +
                          std::to_string(limits.max_memory_bytes) +
                          ". DELETE sessions that are not needed.");
    }
    if (why == StoreRefusal::IdIsTaken) {
        return refuse(request, api::ProblemType::IdTaken,
                      "A session of that id exists: choose another id, or DELETE the session first "
                      "if it is yours.");
    }
    return refuse(request, api::ProblemType::TooManySessions,
                  "The limit max_sessions of " + std::to_string(limits.max_sessions) +
                      " is reached. DELETE sessions that are not needed.");
}

/// Reads the terrain and keeps it. No id: a random one.
Response make_session(Services& services, const Request& request, std::optional<std::string> id) {
    const auto format = require_terrain_format(request);
    if (const auto* refusal = std::get_if<Response>(&format)) return *refusal;
    const auto options = api::parse_terrain_options(options_of_query(request));
    if (!options) return refuse(request, api::problem_of_faults(options.kind(), options.faults()));
    std::optional<MemoryToBuild> memory(std::in_place, services, request);
    auto terrain = load_terrain(request.body, std::get<0>(format), *options,
                                services.read_limits(request.asker),
                                [&memory](std::size_t bytes) { return memory->take(bytes); });
    if (auto refusal = memory->refusal()) return *std::move(refusal);
    if (!terrain) {
        return refuse(request, api::problem_of_faults(terrain.kind(), std::move(terrain.faults())));
    }
    memory.reset();  // what the session holds is counted with it
    const auto added = services.sessions.add(std::move(terrain->tin), terrain->about, request.asker,
                                             std::move(id));
    if (const auto* why = std::get_if<StoreRefusal>(&added)) {
        return refuse_session(request, services.limits_of(request.asker), *why);
    }
    const Session& session = *std::get<0>(added);
    if (session.mesh_bytes() >= kLargeMesh) give_back_memory();
    return tell_created(services.sessions.view(session), session.facts().birth);
}

}  // namespace

Response tell_created(const api::SessionView& view, const std::string& birth) {
    Response response = created("/v1/sessions/" + view.id, kJson, api::write_session(view));
    response.with("ETag", '"' + birth + '-' + std::to_string(view.version) + '"');
    return response;
}

Response list_sessions(Services& services, const Request& request, const PathArguments&) {
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const auto& [limit, after] = std::get<0>(page);
    const auto [views, more] = services.sessions.page(after, limit, request.asker);
    Response response = ok(kJson, api::write_session_list(views));
    if (more) response.with("Link", next_link(request, kCursorKind, limit, views.back().id));
    return response;
}

Response create_session(Services& services, const Request& request, const PathArguments&) {
    return make_session(services, request, std::nullopt);
}

Response put_session(Services& services, const Request& request, const PathArguments& arguments) {
    const std::string& id = arguments[0];
    if (!is_sane_id(id) || id.front() == '.') {
        return refuse(request, api::ProblemType::BadRequest,
                      "An id has 1 to 64 letters, digits, dots, dashes and underscores, and no dot "
                      "in front.");
    }
    // Before the terrain is read, which takes long; the store has the last word all the same.
    if (services.sessions.contains(id)) {
        return refuse_session(request, services.limits_of(request.asker), StoreRefusal::IdIsTaken);
    }
    return make_session(services, request, id);
}

Response get_session(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    const api::SessionView view = services.sessions.view(session);
    if (auto answer = answer_to_conditions(request, session, view.version, {})) return *answer;
    Response response = ok(kJson, api::write_session(view));
    response.with("ETag", session.etag(view.version));
    return response;
}

Response fork_session(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    if (!request.body.empty()) {
        return refuse(request, api::ProblemType::BadRequest,
                      "A fork takes no body: it has what the session has now. Leave it out.");
    }
    const auto forked = services.sessions.fork(*std::get<0>(found), request.asker);
    if (const auto* why = std::get_if<StoreRefusal>(&forked)) {
        return refuse_session(request, services.limits_of(request.asker), *why);
    }
    return tell_created(services.sessions.view(*std::get<0>(forked)),
                        std::get<0>(forked)->facts().birth);
}

Response delete_session(Services& services, const Request& request,
                        const PathArguments& arguments) {
    if (!request.body.empty()) {
        return refuse(request, api::ProblemType::BadRequest,
                      "There is no body here: leave it out.");
    }
    if (const auto damaged = services.sessions.remove_damaged(arguments[0], request.asker))
        return ok(kJson, api::write_session(*damaged));
    auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    auto& session = std::get<0>(found);
    if (auto refusal = refusal_of_blind_edit(services, request, *session)) return *refusal;
    const auto expected = require_if_match(request, *session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;
    std::string last = api::write_session(session->view());
    switch (services.sessions.remove(*session, std::get<0>(expected))) {
        case Removal::OtherVersion:
            return version_mismatch(request, *session, session->view().version);
        case Removal::Gone:
            return no_such_session(services, request, arguments[0]);
        case Removal::Done:
            break;
    }
    services.forget(*session);
    session.reset();
    give_back_memory();
    return ok(kJson, std::move(last));
}

}  // namespace tinsmith::server
