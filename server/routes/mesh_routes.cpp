// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/crs.hpp"
#include "api/responses.hpp"
#include "server/answer_finish.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 2> kMeshTypes{kGlb, kJson};
constexpr int kDone = 200;

/// Every option in the tag and in the key; none: what is sent unless told otherwise.
std::string suffix_of(const api::GltfOptions& options) {
    // Names all members: one that is added has to be told apart here too. The unit is the
    // session's.
    const auto& [compression, tolerance, up, constraints, normals, unit] = options;
    const api::GltfOptions usual;
    if (compression == usual.compression && tolerance == usual.tolerance && up == usual.up &&
        constraints == usual.constraints && normals == usual.normals) {
        return "-glb";
    }
    std::string suffix = compression == api::Compression::Draco ? "-glb-draco-" : "-glb-none-";
    suffix += text_of(tolerance);
    suffix += up == api::UpAxis::Y ? "-y" : "-z";
    if (constraints) suffix += "-constraints";
    if (normals) suffix += "-normals";
    return suffix;
}

/// Null where the library fails; then it goes out as it is.
MeshCache::Found coded_copy(const Request& request, const EncodedMesh& mesh) {
    auto copy = std::make_shared<EncodedMesh>(mesh);
    return encode_as_gzip(request, copy->response) ? copy : nullptr;
}

Response tell(const Session& session, const EncodedMesh& mesh, const std::string& suffix) {
    Response response = mesh.response;
    return response.with("ETag", etag_of(session, mesh.version, suffix));
}

/// The version that the query names; nothing: the mesh as it is now.
Step<std::optional<std::uint64_t>> require_version(const Request& request, const Session& session) {
    const auto text = request.parameter("version");
    if (!text) return std::optional<std::uint64_t>();
    const auto version = parse_version(*text);
    if (!version) {
        std::string detail = "version is a whole number, as the session's history has it.";
        return refuse(request, {api::ProblemType::InvalidParameter,
                                detail,
                                {{"INVALID_VALUE", detail, {}, {}, {}, "version"}}});
    }
    if (auto refusal = refusal_of_version(request, session, *version)) return *std::move(refusal);
    return version;
}

/// A copy of the mesh as it is now or was, or why there is none.
Step<MeshCopy> copy_mesh(Services& services, const Session& session, const Request& request,
                         std::optional<std::uint64_t> version) {
    if (!version) return session.copy_mesh();
    const auto memory = require_memory(services, request, session.mesh_bytes_since(*version));
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const auto tin = session.tin_at(*version, rerun_limits(services.limits, services.stopping));
    if (const auto* mesh = std::get_if<core::Tin>(&tin)) return MeshCopy{mesh->to_data(), *version};
    return refuse_version(request, session, tin);
}

/// One representation of the mesh: conditions first, then what is kept, then `write`, which makes
/// an answer of a copy of the mesh. What `write` refuses goes out and is not kept.
template <typename Write>
Response send(Services& services, const Session& session, const Request& request,
              const std::string& suffix, const Write& write) {
    const auto asked = require_version(request, session);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const std::uint64_t version = std::get<0>(asked).value_or(session.view().version);
    if (auto answer = answer_to_conditions(request, session, version, suffix)) return *answer;
    std::optional<Response> refusal;
    const std::string& birth = session.facts().birth;
    const auto encode = [&]() -> MeshCache::Found {
        auto copy = copy_mesh(services, session, request, std::get<0>(asked));
        if (auto* none = std::get_if<Response>(&copy)) {
            refusal = std::move(*none);
            return nullptr;
        }
        const auto& [mesh, of] = std::get<0>(copy);
        Response response = write(mesh);
        if (response.status == kDone) {
            return std::make_shared<const EncodedMesh>(EncodedMesh{of, std::move(response)});
        }
        refusal = std::move(response);
        return nullptr;
    };
    const auto found = services.meshes.get({birth, version, suffix}, encode);
    // Of a session that was removed meanwhile nothing may stay behind.
    if (!services.sessions.is_kept(session)) services.meshes.forget(birth);
    if (!found) return *std::move(refusal);
    if (wants_gzip(request, found->response)) {
        const std::string coded = suffix + std::string(kGzipSuffix);
        const auto mesh = services.meshes.get({birth, found->version, coded},
                                              [&] { return coded_copy(request, *found); });
        if (mesh) return tell(session, *mesh, coded);
    }
    return tell(session, *found, suffix);
}

Response send_glb(Services& services, const Session& session, const Request& request) {
    auto given = options_of_query(request);
    std::erase_if(given, [](const api::NamedOption& option) { return option.name == "version"; });
    auto options = api::parse_mesh_options(given);
    if (!options) {
        return refuse(request, api::problem_of_faults(options.kind(), std::move(options.faults())));
    }
    options->unit_to_metre = api::metres_per(session.facts().unit);
    return send(services, session, request, suffix_of(*options),
                [&](const core::MeshData& mesh) { return glb_response(request, mesh, *options); });
}

Response send_json(Services& services, const Session& session, const Request& request) {
    for (const auto& [name, value] : request.query) {
        if (name == "version") continue;
        return refuse(request, api::ProblemType::InvalidParameter,
                      "The JSON mesh has no options but version: full doubles, z up. Leave \"" +
                          name + "\" out, or ask for model/gltf-binary.");
    }
    return send(services, session, request, "-json",
                [](const core::MeshData& mesh) { return ok(kJson, api::write_mesh_json(mesh)); });
}

using Sender = Response (*)(Services&, const Session&, const Request&);

Response send_mesh(Services& services, const Request& request, const std::string& id,
                   Sender sender) {
    const auto session = require_session(services, request, id);
    if (const auto* refusal = std::get_if<Response>(&session)) return *refusal;
    return sender(services, *std::get<0>(session), request);
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
