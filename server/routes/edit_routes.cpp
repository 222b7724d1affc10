// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "api/edit_answer.hpp"
#include "api/media_type.hpp"
#include "server/edit_making.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 4> kAnswerTypes{kJson, kGlb, kDelta, kGltf};

std::optional<Response> refusal_of_type(const Request& request) {
    const std::string type = api::media_type_of(request.header("content-type").value_or(""));
    if (type == "application/json") return std::nullopt;
    return refuse_media_type(request, type, "an edit", "application/json",
                             "-H 'Content-Type: application/json'");
}

Response refuse_edit(const Request& request, const std::string& polygon, const NoEdit& no) {
    if (const auto* fault = std::get_if<PolygonFault>(&no))
        return refuse_polygon(request, polygon, *fault);
    if (const auto* fault = std::get_if<api::Fault>(&no)) {
        return refuse(request, api::problem_of_faults(api::FaultKind::Invalid, {*fault}));
    }
    const auto& errors = std::get<core::Errors>(no);
    api::Faults faults = faults_of(errors, {});
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const bool is_of_polygon = errors[i].code == core::ErrorCode::NothingInside ||
                                   errors[i].code == core::ErrorCode::NothingLeft;
        if (is_of_polygon) faults[i].pointer = "/polygon";
    }
    return refuse(request, api::problem_of_errors(errors, std::move(faults)));
}

/// What is asked for beside the body.
struct Wishes {
    std::string_view type;  ///< of the answer
    api::GltfOptions gltf;  ///< how the mesh is to be written, if that is the answer
    std::optional<std::uint64_t> expected_version;
    bool dry_run = false;

    bool wants_mesh() const { return type == kGlb || type == kGltf; }
};

Step<Wishes> require_wishes(Services& services, const Request& request, const Session& session) {
    const auto type = require_media_type(request, kAnswerTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto expected = require_if_match(request, session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;
    const auto dry_run = require_flag(request, "dry_run");
    if (const auto* refusal = std::get_if<Response>(&dry_run)) return *refusal;
    const std::string_view answer_type = kAnswerTypes[std::get<0>(type)];
    const auto gltf = require_gltf_options(request, answer_type);
    if (const auto* refusal = std::get_if<Response>(&gltf)) return *refusal;
    const Wishes wishes{answer_type, std::get<0>(gltf), std::get<0>(expected),
                        std::get<0>(dry_run)};
    if (!wishes.dry_run) {
        if (auto refusal = refusal_of_blind_edit(services, request, session)) return *refusal;
    } else if (wishes.type == kDelta) {
        return refuse_delta_of_dry_run(request);
    }
    return wishes;
}

Response send_edit(Metrics& metrics, const Request& request, const Session& session,
                   const EditResult& result, const Wishes& wishes) {
    Response response =
        wishes.wants_mesh() ? mesh_after(metrics, request, session, result.version, result.mesh,
                                         wishes.dry_run, wishes.type, wishes.gltf)
        : wishes.type == kDelta
            ? delta_response(metrics, request, session, result.version, result.delta)
            : ok(kJson, api::write_edit(session.facts().id, result.version, wishes.dry_run,
                                        *result.answer));
    if (!wishes.dry_run) response.with("Link", history_link(session, result.version));
    return response.with("ETag", session.etag(result.version)).with("Vary", "Accept");
}

}  // namespace

Response edit_polygon(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    Session& session = *std::get<0>(found);
    if (auto refusal = refusal_of_type(request)) return *refusal;
    if (auto refusal = refusal_of_memory(services, request)) return *refusal;
    const auto wished = require_wishes(services, request, session);
    if (const auto* refusal = std::get_if<Response>(&wished)) return *refusal;
    const Wishes& wishes = std::get<0>(wished);
    begin_stage(0.1);
    auto asked = api::read_edit_request(request.body, services.read_limits(request.asker));
    if (!asked) {
        return refuse(request, api::problem_of_faults(asked.kind(), std::move(asked.faults())));
    }
    const bool as_mesh = wishes.wants_mesh();
    const std::size_t mesh_bytes = session.mesh_bytes();
    const auto memory = require_memory(
        services, request,
        (wishes.dry_run ? mesh_bytes : 0) + (as_mesh ? bytes_to_encode(mesh_bytes) : 0));
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;

    auto made = make_edit(session, *asked, services.limits_of(request.asker), services.stopping);
    if (const auto* no = std::get_if<NoEdit>(&made))
        return refuse_edit(request, asked->polygon, *no);
    auto& edit = std::get<PendingEdit>(made);
    begin_stage(0.8);
    edit.dry_run = wishes.dry_run;
    edit.want_mesh = as_mesh;
    edit.want_delta = wishes.type == kDelta;
    edit.expected_version = wishes.expected_version;
    const Stopwatch watch;
    const auto outcome = session.edit(std::move(edit));
    if (const auto* mismatch = std::get_if<VersionMismatch>(&outcome))
        return version_mismatch(request, session, mismatch->current);
    if (const auto* fault = std::get_if<PolygonFault>(&outcome))
        return refuse_edit(request, asked->polygon, *fault);
    if (const auto* errors = std::get_if<core::Errors>(&outcome))
        return refuse_edit(request, asked->polygon, *errors);
    const auto& result = std::get<EditResult>(outcome);
    services.metrics.edited(result.answer->report, watch.seconds(), wishes.dry_run);
    if (!wishes.dry_run && !services.sessions.is_kept(session)) {
        return refuse(request, api::ProblemType::NoSuchSession,
                      "The session was deleted while the edit ran: nothing of it is kept.");
    }
    begin_stage(1.0);
    return send_edit(services.metrics, request, session, result, wishes);
}

}  // namespace tinsmith::server
