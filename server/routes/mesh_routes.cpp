// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "api/crs.hpp"
#include "api/responses.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 2> kMeshTypes{kGlb, kJson};

Response send_glb(const Session& session, const Request& request) {
    auto options = api::parse_mesh_options(options_of_query(request));
    if (!options) {
        return refuse(request, api::problem_of_faults(options.kind(), std::move(options.faults())));
    }
    options->unit_to_metre = api::metres_per(session.facts().unit);
    const MeshCopy copy = session.copy_mesh();
    Response response = glb_response(request, copy.mesh, *options);
    if (response.status == 200) response.with("ETag", etag_of(session, copy.version, "-glb"));
    return response;
}

Response send_json(const Session& session, const Request& request) {
    if (!request.query.empty()) {
        return refuse(request, api::ProblemType::InvalidParameter,
                      "The JSON mesh has no options: full doubles, z up. Leave \"" +
                          request.query.front().first + "\" out, or ask for model/gltf-binary.");
    }
    const MeshCopy copy = session.copy_mesh();
    Response response = ok(kJson, api::write_mesh_json(copy.mesh));
    response.with("ETag", etag_of(session, copy.version, "-json"));
    return response;
}

using Sender = Response (*)(const Session&, const Request&);

Response send_mesh(Services& services, const Request& request, const std::string& id,
                   Sender sender) {
    const auto session = require_session(services, request, id);
    if (const auto* refusal = std::get_if<Response>(&session)) return *refusal;
    return sender(*std::get<0>(session), request);
}

}  // namespace

Response get_mesh(Services& services, const Request& request, const PathArguments& arguments) {
    if (request.parameter("since")) return get_delta(services, request, arguments);
    const auto type = require_media_type(request, kMeshTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    Response response =
        send_mesh(services, request, arguments[0], std::get<0>(type) == 0 ? send_glb : send_json);
    response.with("Vary", "Accept");
    return response;
}

Response get_mesh_glb(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], send_glb);
}

Response get_mesh_json(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], send_json);
}

}  // namespace tinsmith::server
