// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/landxml_writer.hpp"
#include "api/formats/obj_writer.hpp"
#include "api/responses.hpp"
#include "server/answer_finish.hpp"
#include "server/heap.hpp"
#include "server/mesh_source.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

enum class MeshFormat { Glb, Json, Gltf, Obj, LandXml };

/// In the order of the formats.
constexpr std::array<std::string_view, 5> kMeshTypes{kGlb, kJson, kGltf, kObj, kXml};
constexpr int kDone = 200;
/// In bytes: what encoding one of these takes is worth giving back.

/// Meshes with full doubles have few options.
constexpr std::array<std::string_view, 2> kJsonOptions{"version", "bbox"};
constexpr std::array<std::string_view, 3> kExchangeOptions{"version", "bbox", "constraints"};

bool is_gltf(MeshFormat format) {
    return format == MeshFormat::Glb || format == MeshFormat::Gltf;
}

std::span<const std::string_view> options_of(MeshFormat format) {
    if (is_gltf(format)) return api::mesh_option_names();
    return format == MeshFormat::Json ? std::span<const std::string_view>(kJsonOptions)
                                      : std::span<const std::string_view>(kExchangeOptions);
}

/// Every option of glTF in the tag and in the key; none: what is sent unless told otherwise.
std::string gltf_suffix_of(const api::MeshOptions& options) {
    // Names all members: one that is added has to be told apart here too. Unit and system are the
    // session's.
    const auto& [gltf, regions, bbox] = options;
    const auto& [compression, tolerance, up, constraints, normals, unit, crs] = gltf;
    const api::GltfOptions usual;
    std::string suffix;
    if (compression != usual.compression || tolerance != usual.tolerance || up != usual.up ||
        constraints != usual.constraints || normals != usual.normals) {
        suffix += compression == api::Compression::Draco     ? "-draco-"
                  : compression == api::Compression::Meshopt ? "-meshopt-"
                                                             : "-none-";
        suffix += text_of(tolerance);
        suffix += up == api::UpAxis::Y ? "-y" : "-z";
        if (constraints) suffix += "-constraints";
        if (normals) suffix += "-normals";
    }
    if (regions) suffix += "-regions";
    return suffix;
}

std::string suffix_of(MeshFormat format, const api::MeshOptions& options) {
    static constexpr std::array<std::string_view, 5> kNames{"-glb", "-json", "-gltf", "-obj",
                                                            "-landxml"};
    std::string suffix(kNames[static_cast<std::size_t>(format)]);
    if (is_gltf(format)) suffix += gltf_suffix_of(options);
    const bool has_edges = format == MeshFormat::Obj || format == MeshFormat::LandXml;
    if (has_edges && options.gltf.constraints) suffix += "-constraints";
    if (const auto& box = options.bbox) {
        suffix += "-bbox";
        for (const double bound : {box->min_x, box->min_y, box->max_x, box->max_y})
            suffix += "_" + text_of(bound);
    }
    return suffix;
}

/// Null where the library fails; then it goes out as it is.
MeshCache::Found coded_copy(const Request& request, const EncodedMesh& mesh) {
    auto copy = std::make_shared<EncodedMesh>(mesh);
    return encode_as_gzip(request, copy->response) ? copy : nullptr;
}

Response tell(const Session& session, const MeshCache::Found& mesh, const std::string& suffix) {
    Response response;
    response.status = mesh->response.status;
    response.content_type = mesh->response.content_type;
    response.headers = mesh->response.headers;
    response.shared_body = {mesh, &mesh->response.body};
    return response.with("ETag", etag_of(session, mesh->version, suffix));
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

/// Memory for a copy of the mesh and all that is made of it, to be held until the answer is there.
Step<BorrowedMemory> require_memory_to_encode(Services& services, const Session& session,
                                              const Request& request,
                                              std::optional<std::uint64_t> version, bool regions) {
    const std::size_t of_mesh = version ? session.mesh_bytes_since(*version) : session.mesh_bytes();
    std::size_t bytes = bytes_to_encode(of_mesh) + (version ? of_mesh : 0);
    if (regions) {
        bytes += session.mesh_bytes() +
                 session.look([](const core::Tin& tin, const std::vector<Polygon>& polygons,
                                 std::uint64_t) { return partition_bytes(tin, polygons); });
    }
    return require_memory(services, request, bytes);
}

/// A copy of the mesh as it is now or was, or why there is none.
Step<MeshGround> copy_ground(Services& services, const Session& session, const Request& request,
                             std::optional<std::uint64_t> version, bool regions) {
    if (!version) return ground_now(session, regions);
    const auto limits = rerun_limits(services.limits_of(request.asker), services.stopping);
    const auto outcome = session.state_at(*version, limits);
    if (const auto* state = std::get_if<SessionState>(&outcome))
        return ground_of(*state, *version, regions);
    return refuse_version(request, session, outcome);
}

/// One representation of the mesh: conditions first, then what is kept, then `write`, which makes
/// an answer of a copy of the mesh. What `write` refuses goes out and is not kept.
template <typename Write>
Response send(Services& services, const Session& session, const Request& request,
              const std::string& suffix, bool regions, const Write& write) {
    const auto asked = require_version(request, session);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const std::uint64_t version = std::get<0>(asked).value_or(session.view().version);
    if (auto answer = answer_to_conditions(request, session, version, suffix)) return *answer;
    std::optional<Response> refusal;
    const std::string& birth = session.facts().birth;
    const auto encode = [&]() -> MeshCache::Found {
        const auto memory =
            require_memory_to_encode(services, session, request, std::get<0>(asked), regions);
        if (const auto* none = std::get_if<Response>(&memory)) {
            refusal = *none;
            return nullptr;
        }
        auto copy = copy_ground(services, session, request, std::get<0>(asked), regions);
        if (auto* none = std::get_if<Response>(&copy)) {
            refusal = std::move(*none);
            return nullptr;
        }
        const std::uint64_t of = std::get<0>(copy).version;
        Response response = write(std::get<0>(std::move(copy)));
        if (session.mesh_bytes() >= kLargeMesh) give_back_memory();
        if (response.status == kDone) {
            return std::make_shared<const EncodedMesh>(EncodedMesh{of, std::move(response)});
        }
        refusal = std::move(response);
        return nullptr;
    };
    auto found = services.meshes.get({birth, version, suffix}, encode);
    // Who asked for the mesh as it is now may have been given a later one, under this key.
    while (found && std::get<0>(asked) && found->version != version)
        found = services.meshes.get({birth, version, suffix}, encode);
    // Of a session that was removed meanwhile nothing may stay behind.
    if (!services.sessions.is_kept(session)) services.meshes.forget(birth);
    if (!found) return *std::move(refusal);
    if (wants_gzip(request, found->response)) {
        const std::string coded = suffix + std::string(kGzipSuffix);
        const auto mesh = services.meshes.get({birth, found->version, coded},
                                              [&] { return coded_copy(request, *found); });
        if (mesh) return tell(session, mesh, coded);
    }
    return tell(session, found, suffix);
}

Response write_as(Metrics& metrics, const Request& request, const SessionFacts& facts,
                  const MeshSource& source, MeshFormat format, const api::MeshOptions& options) {
    if (is_gltf(format)) {
        return gltf_response(metrics, request, source.mesh, options.gltf,
                             {kMeshTypes[static_cast<std::size_t>(format)],
                              source.regions ? &*source.regions : nullptr});
    }
    const EncodeMeter meter(metrics, format == MeshFormat::Json  ? EncodeFormat::Json
                                     : format == MeshFormat::Obj ? EncodeFormat::Obj
                                                                 : EncodeFormat::LandXml);
    Response response;
    if (format == MeshFormat::Json) {
        response = ok(kJson, api::write_mesh_json(source.mesh));
    } else if (format == MeshFormat::Obj) {
        const std::string system = facts.crs.empty() ? "no named system" : facts.crs;
        response = ok(kObj, api::write_obj(source.mesh, options.gltf.constraints,
                                           "Tinsmith: x y z in " + system + ", " + facts.unit));
    } else {
        response = ok(kXml, api::write_landxml(source.mesh, {facts.name, facts.crs, facts.unit,
                                                             options.gltf.constraints}));
    }
    return response.with("Tinsmith-Triangles", std::to_string(source.mesh.triangles.size()));
}

Response refuse_source(const Request& request, NoSource no) {
    if (const auto* errors = std::get_if<core::Errors>(&no))
        return refuse_question(request, *errors);
    return refuse(request, api::problem_of_faults(api::FaultKind::Parameter,
                                                  {std::get<api::Fault>(std::move(no))}));
}

/// The query's options, but for the version, which is the session's matter.
Step<api::MeshOptions> require_options(const Request& request, MeshFormat format) {
    std::vector<api::NamedOption> given;
    const auto known = options_of(format);
    for (const api::NamedOption& option : options_of_query(request)) {
        if (std::ranges::find(known, option.name) == known.end()) {
            std::string names;
            for (const std::string_view name : known)
                names.append(names.empty() ? "" : ", ").append(name);
            return refuse(request, api::ProblemType::InvalidParameter,
                          "The mesh as " +
                              std::string(kMeshTypes[static_cast<std::size_t>(format)]) +
                              " has full doubles, z up, and no options but " + names +
                              ". Leave \"" + option.name + "\" out, or ask for model/gltf-binary.");
        }
        if (option.name != "version") given.push_back(option);
    }
    auto options = api::parse_mesh_options(given);
    if (!options) {
        return refuse(request, api::problem_of_faults(options.kind(), std::move(options.faults())));
    }
    // Many readers of OBJ know no lines.
    if (format == MeshFormat::Obj && !request.parameter("constraints"))
        options->gltf.constraints = false;
    return *std::move(options);
}

Response send_mesh(Services& services, const Request& request, const std::string& id,
                   MeshFormat format) {
    const auto found = require_session(services, request, id);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    const auto asked = require_options(request, format);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    api::MeshOptions options = std::get<0>(asked);
    options.gltf.unit_to_metre = api::metres_per(session.facts().unit);
    options.gltf.crs = session.facts().crs;
    return send(services, session, request, suffix_of(format, options), options.regions,
                [&](MeshGround ground) {
                    auto source =
                        source_of(std::move(ground), options, session.facts().unit,
                                  {services.limits_of(request.asker).max_crossings,
                                   deadline(services.limits_of(request.asker), services.stopping)});
                    if (auto* no = std::get_if<NoSource>(&source))
                        return refuse_source(request, std::move(*no));
                    return write_as(services.metrics, request, session.facts(),
                                    std::get<MeshSource>(source), format, options);
                });
}

}  // namespace

Response get_mesh(Services& services, const Request& request, const PathArguments& arguments) {
    if (request.parameter("since")) return get_delta(services, request, arguments);
    const auto type = require_media_type(request, kMeshTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    Response response =
        send_mesh(services, request, arguments[0], static_cast<MeshFormat>(std::get<0>(type)));
    response.with("Vary", "Accept");
    return response;
}

Response get_mesh_glb(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], MeshFormat::Glb);
}

Response get_mesh_gltf(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], MeshFormat::Gltf);
}

Response get_mesh_json(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], MeshFormat::Json);
}

Response get_mesh_obj(Services& services, const Request& request, const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], MeshFormat::Obj);
}

Response get_mesh_landxml(Services& services, const Request& request,
                          const PathArguments& arguments) {
    return send_mesh(services, request, arguments[0], MeshFormat::LandXml);
}

}  // namespace tinsmith::server
