// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_support.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "api/crs.hpp"
#include "api/media_type.hpp"
#include "api/problem.hpp"
#include "api/side_by_side.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

api::ProblemType problem_of(api::EncodeFault fault) {
    switch (fault) {
        case api::EncodeFault::BadOption:
        case api::EncodeFault::ToleranceTooFine:
            return api::ProblemType::InvalidParameter;
        case api::EncodeFault::TooLarge:
            return api::ProblemType::BudgetExceeded;
        case api::EncodeFault::BadMesh:
        case api::EncodeFault::Codec:
            return api::ProblemType::Internal;
    }
    return api::ProblemType::Internal;
}

}  // namespace

std::string text_of(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

Step<std::shared_ptr<Session>> require_session(Services& services, const Request& request,
                                               const std::string& id) {
    if (auto session = services.sessions.find(id, request.asker)) return session;
    return no_such_session(services, request, id);
}

Response no_such_session(const Services& services, const Request& request, const std::string& id) {
    return refuse(request, api::ProblemType::NoSuchSession,
                  "No session has the id \"" + id.substr(0, 64) +
                      "\". GET /v1/sessions lists them" +
                      (services.vault ? "." : "; they are gone when the server stops."));
}

Response no_such_polygon(const Request& request, const Session& session, const std::string& id) {
    return refuse(request, api::ProblemType::NoSuchPolygon,
                  "No polygon of this session has the id \"" + id.substr(0, 64) +
                      "\". GET /v1/sessions/" + session.facts().id + "/polygons lists them.");
}

std::uint64_t polygon_number(std::string_view id) {
    std::uint64_t number = 0;
    if (id.starts_with('p')) std::from_chars(id.data() + 1, id.data() + id.size(), number);
    return number;
}

Step<std::size_t> require_media_type(const Request& request,
                                     std::span<const std::string_view> offers) {
    std::string accept;
    for (const auto& [name, value] : request.headers) {
        if (name == "accept") accept += (accept.empty() ? "" : ", ") + value;
    }
    if (const auto chosen = api::choose_media_type(accept, offers)) return *chosen;
    std::string known;
    for (const std::string_view offer : offers) {
        known += known.empty() ? "" : ", ";
        known += offer;
    }
    return refuse(request, api::ProblemType::NotAcceptable,
                  "Accept names nothing that can be sent here; there is: " + known + ".")
        .with("Vary", "Accept");
}

Response refuse_media_type(const Request& request, const std::string& type, std::string_view what,
                           std::string_view known, std::string_view curl_hint) {
    std::string detail = type.empty() ? std::string("There is no Content-Type.")
                                      : "The Content-Type " + type + " is not read here.";
    detail.append(" Send ").append(what).append(" as one of: ").append(known).append(".");
    if (type == "application/x-www-form-urlencoded") {
        detail.append(" That type is what curl says unless told otherwise: add ");
        detail.append(curl_hint).append(".");
    }
    return refuse(request, api::ProblemType::UnsupportedMediaType, std::move(detail));
}

std::vector<api::NamedOption> options_of_query(const Request& request) {
    std::vector<api::NamedOption> options;
    for (const auto& [name, value] : request.query)
        options.push_back({name, value, {}});
    return options;
}

std::vector<api::NamedOption> options_of_query(const Request& request,
                                               std::span<const std::string_view> names) {
    auto options = options_of_query(request);
    std::erase_if(options, [&](const api::NamedOption& option) {
        return std::ranges::find(names, option.name) == names.end();
    });
    return options;
}

Step<api::GltfOptions> require_gltf_options(const Request& request, std::string_view type) {
    const auto given = options_of_query(request, api::gltf_option_names());
    if (!given.empty() && type != kGlb && type != kGltf) {
        std::string detail = given.front().name + " is about glTF, and the answer is to be " +
                             std::string(type) +
                             ": leave it out, or add the header Accept: " + std::string(kGlb) + ".";
        return refuse(request, {api::ProblemType::InvalidParameter,
                                detail,
                                {{"CONTRADICTION", detail, {}, {}, {}, given.front().name}}});
    }
    auto options = api::parse_mesh_options(given);
    if (options) return std::move(options->gltf);
    return refuse(request, api::problem_of_faults(options.kind(), std::move(options.faults())));
}

Response gltf_response(Metrics& metrics, const Request& request, const core::MeshData& mesh,
                       const api::GltfOptions& options, const GltfAnswer& as) {
    const EncodeMeter meter(metrics, as.type == kGlb ? EncodeFormat::Glb : EncodeFormat::Gltf,
                            options.compression);
    auto written = as.type == kGlb ? api::write_glb(mesh, options, as.regions, api::side_by_side)
                                   : api::write_gltf(mesh, options, as.regions, api::side_by_side);
    if (const auto* error = std::get_if<api::EncodeError>(&written)) {
        return refuse(request, problem_of(error->fault), error->detail + as.note);
    }
    auto& glb = std::get<api::GltfResult>(written);
    Response response = ok(std::string(as.type), std::move(glb.bytes));
    response.with("Tinsmith-Max-Error", text_of(glb.max_error))
        .with("Tinsmith-Flipped-Triangles", std::to_string(glb.flipped))
        .with("Tinsmith-Collapsed-Triangles", std::to_string(glb.collapsed))
        .with("Tinsmith-Position-Bits", std::to_string(glb.bits))
        .with("Tinsmith-Triangles", std::to_string(mesh.triangles.size()))
        .with("Tinsmith-Origin",
              text_of(glb.origin[0]) + " " + text_of(glb.origin[1]) + " " + text_of(glb.origin[2]));
    return response;
}

Response delta_response(Metrics& metrics, const Request& request, const Session& session,
                        std::uint64_t version, const std::optional<api::MeshDelta>& delta) {
    const EncodeMeter meter(metrics, EncodeFormat::Delta);
    if (delta) return ok(kDelta, api::write_delta(*delta));
    return refuse(request, api::ProblemType::OutOfMemory,
                  "There is no memory to send the delta now: get it later from /v1/sessions/" +
                      session.facts().id + "/mesh?since=" + std::to_string(version - 1) +
                      ". The edit was made: the session has version " + std::to_string(version) +
                      ".");
}

Response mesh_after(Metrics& metrics, const Request& request, const Session& session,
                    std::uint64_t version, const std::optional<core::MeshData>& mesh, bool dry_run,
                    std::string_view type, api::GltfOptions options) {
    const std::string made =
        " The edit was made: the session has version " + std::to_string(version) + ".";
    if (!mesh) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "There is no memory to send the mesh now: get it later." + made);
    }
    options.unit_to_metre = api::metres_per(session.facts().unit);
    options.crs = session.facts().crs;
    return gltf_response(metrics, request, *mesh, options,
                         {type, nullptr, dry_run ? std::string() : made});
}

Response refuse_delta_of_dry_run(const Request& request) {
    return refuse(request, api::ProblemType::InvalidParameter,
                  "A dry run makes no version that a delta could lead to: leave dry_run out, or "
                  "ask for application/json or model/gltf-binary.");
}

Response refuse_angles_of_mesh(const Request& request) {
    return refuse(request, api::ProblemType::InvalidParameter,
                  "The counts of angles stand in the report: leave angles out, or ask for "
                  "application/json.");
}

Step<bool> require_flag(const Request& request, const std::string& name) {
    const auto flag = request.parameter(name);
    if (!flag || *flag == "false") return false;
    if (*flag == "true") return true;
    std::string detail = name + " is true or false.";
    return refuse(request, {api::ProblemType::InvalidParameter,
                            detail,
                            {{"INVALID_VALUE", detail, {}, {}, {}, name}}});
}

Response refuse_polygon(const Request& request, const std::string& id, PolygonFault fault) {
    if (fault == PolygonFault::NotThere) {
        std::string detail = "No polygon of this session has the id \"" + id.substr(0, 64) +
                             "\". GET /v1/sessions/{id}/polygons lists them.";
        return refuse(request, api::Problem{api::ProblemType::NoSuchPolygon,
                                            detail,
                                            {{"NO_SUCH_POLYGON", detail, "/polygon"}}});
    }
    return refuse(request, api::problem_of_faults(
                               api::FaultKind::Invalid,
                               {{"NO_INSIDE",
                                 "\"" + id.substr(0, 64) +
                                     "\" is a line or a point and has no inside: name a polygon.",
                                 "/polygon"}}));
}

std::string history_link(const Session& session, std::uint64_t version) {
    return "</v1/sessions/" + session.facts().id + "/history/" + std::to_string(version) +
           ">; rel=\"describedby\"";
}

std::optional<std::uint64_t> parse_version(std::string_view text) {
    std::uint64_t version = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, version);
    return error == std::errc() && stop == end ? std::optional(version) : std::nullopt;
}

Response version_ahead(const Request& request, const VersionAhead& ahead) {
    return refuse(request, api::ProblemType::NoSuchVersion,
                  "Versions are whole numbers from 1 to the current one, which is " +
                      std::to_string(ahead.current) + ".");
}

Response version_gone(const Request& request, const Session& session, const VersionGone& gone) {
    return refuse(request, api::ProblemType::VersionGone,
                  "That version is no longer kept. The oldest kept is " +
                      std::to_string(gone.oldest) + "; /v1/sessions/" + session.facts().id +
                      "/mesh?since=0 is the whole mesh.");
}

namespace {

template <typename Outcome>
Response refuse_outcome(const Request& request, const Session& session, const Outcome& outcome) {
    if (const auto* gone = std::get_if<VersionGone>(&outcome)) {
        return version_gone(request, session, *gone);
    }
    if (const auto* ahead = std::get_if<VersionAhead>(&outcome)) {
        return version_ahead(request, *ahead);
    }
    api::Problem problem = api::problem_of_errors(std::get<core::Errors>(outcome), {});
    problem.detail =
        "To make that version again took longer than max_edit_seconds of /v1/limits, or the server "
        "is "
        "stopping.";
    return refuse(request, problem);
}

}  // namespace

Response refuse_version(const Request& request, const Session& session,
                        const VersionOutcome& outcome) {
    return refuse_outcome(request, session, outcome);
}

Response refuse_version(const Request& request, const Session& session,
                        const StateOutcome& outcome) {
    return refuse_outcome(request, session, outcome);
}

std::optional<Response> refusal_of_version(const Request& request, const Session& session,
                                           std::uint64_t version) {
    const auto missing = session.missing(version);
    if (const auto* gone = std::get_if<VersionGone>(&missing)) {
        return version_gone(request, session, *gone);
    }
    if (const auto* ahead = std::get_if<VersionAhead>(&missing)) {
        return version_ahead(request, *ahead);
    }
    return std::nullopt;
}

Response refuse_question(const Request& request, const core::Errors& errors,
                         const std::vector<api::RequestedShape>& shapes, const std::string& limit) {
    api::Faults faults = faults_of(errors, shapes);
    for (api::Fault& fault : faults)
        fault.limit = limit;
    api::Problem problem = api::problem_of_errors(errors, std::move(faults));
    if (problem.type == api::ProblemType::Stopped) {
        problem.detail =
            "The question took longer than max_edit_seconds of /v1/limits, or the server is "
            "stopping. Ask "
            "for smaller parts, or try again.";
    }
    return refuse(request, problem);
}

Step<BorrowedMemory> require_memory(Services& services, const Request& request, std::size_t bytes) {
    if (auto memory = services.sessions.borrow(bytes)) return *std::move(memory);
    return refuse(request, api::ProblemType::OutOfMemory,
                  "The copies that this needs, about " + std::to_string(bytes) +
                      " bytes, would pass the limit max_memory_bytes of " +
                      std::to_string(services.limits.max_memory_bytes) +
                      " with all meshes. Try again later, or DELETE sessions that are not needed.");
}

bool MemoryToBuild::take(std::size_t bytes) {
    auto memory = services_.sessions.borrow(bytes);
    if (memory) {
        memory_.emplace(*std::move(memory));
    } else {
        refused_ = bytes;
    }
    return memory_.has_value();
}

std::optional<Response> MemoryToBuild::refusal() const {
    if (refused_ == 0) return std::nullopt;
    return refuse(request_, api::ProblemType::OutOfMemory,
                  "To build this mesh takes about " + std::to_string(refused_) +
                      " bytes, which would pass the limit max_memory_bytes of " +
                      std::to_string(services_.limits.max_memory_bytes) +
                      " with all meshes. Try again later, or DELETE sessions that are not needed.");
}

std::optional<Response> refusal_of_memory(Services& services, const Request& request) {
    const auto quota = request.asker.quotas.max_memory_bytes;
    if (quota && services.sessions.share_of(request.asker.id).memory_bytes > *quota) {
        return refuse(request, api::ProblemType::OutOfMemory,
                      "The sessions of this key have passed its quota max_memory_bytes of " +
                          std::to_string(*quota) + ". DELETE those that are not needed.");
    }
    const std::size_t most = services.limits.max_memory_bytes;
    if (services.sessions.has_room(0)) return std::nullopt;
    return refuse(request, api::ProblemType::OutOfMemory,
                  "All meshes together have passed the limit max_memory_bytes of " +
                      std::to_string(most) + ". DELETE sessions that are not needed.");
}

}  // namespace tinsmith::server
