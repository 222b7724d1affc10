// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/geojson.hpp"
#include "api/media_type.hpp"
#include "api/responses.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "polygon";
constexpr std::array<std::string_view, 4> kAnswerTypes{kJson, kGlb, kDelta, kGltf};
constexpr std::array<std::string_view, 2> kFeatureTypes{kGeoJson, kJson};

std::optional<Response> refusal_of_type(const Request& request) {
    const std::string type = api::media_type_of(request.header("content-type").value_or(""));
    if (type == "application/json" || type == "application/geo+json") return std::nullopt;
    return refuse_media_type(request, type, "polygons", "application/geo+json, application/json",
                             "-H 'Content-Type: application/json'");
}

Response send_report(const Session& session, const PolygonResult& result, bool dry_run) {
    return ok(kJson,
              api::write_report({session.facts().id, result.version, dry_run, result.polygon_ids,
                                 *result.report, std::nullopt, result.angles}));
}

/// GeoJSON and JSON differ in their type alone, and so have tags of their own.
std::string_view suffix_of(std::size_t type) {
    return type == 0 ? "-geojson" : "-json";
}

Response send_features(const Session& session, const DrapedCopy& copy, std::size_t type,
                       std::string body) {
    return ok(std::string(kFeatureTypes[type]), std::move(body))
        .with("ETag", etag_of(session, copy.version, suffix_of(type)))
        .with("Vary", "Accept");
}

/// 304 and the like, before anything is written.
std::optional<Response> answer_early(const Request& request, const Session& session,
                                     std::size_t type) {
    auto answer = answer_to_conditions(request, session, session.view().version, suffix_of(type));
    if (answer) answer->with("Vary", "Accept");
    return answer;
}

}  // namespace

Response integrate_polygons(Services& services, const Request& request,
                            const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    Session& session = *std::get<0>(found);
    if (auto refusal = refusal_of_type(request)) return *refusal;
    if (auto refusal = refusal_of_memory(services, request)) return *refusal;
    const auto type = require_media_type(request, kAnswerTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const std::string_view answer_type = kAnswerTypes[std::get<0>(type)];
    const auto gltf = require_gltf_options(request, answer_type);
    if (const auto* refusal = std::get_if<Response>(&gltf)) return *refusal;
    const auto expected = require_if_match(request, session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;

    begin_stage(0.1);
    auto work =
        read_polygon_work(request.body, options_of_query(request, api::polygon_option_names()),
                          services.read_limits(request.asker));
    if (!work) {
        return refuse(request, api::problem_of_faults(work.kind(), std::move(work.faults())));
    }
    if (auto faults = bring_into(*work, session.facts().crs); !faults.empty()) {
        return refuse(request, api::problem_of_faults(api::FaultKind::Invalid, std::move(faults)));
    }

    const bool as_mesh = answer_type == kGlb || answer_type == kGltf;
    const bool as_delta = answer_type == kDelta;
    work->edit.want_mesh = as_mesh;
    work->edit.want_delta = as_delta;
    work->edit.expected_version = std::get<0>(expected);
    begin_stage(0.8);
    set_budgets(work->edit, services.limits_of(request.asker), services.stopping);
    const bool dry_run = work->edit.dry_run;
    if (dry_run && as_delta) {
        return refuse_delta_of_dry_run(request);
    }
    if (work->edit.want_angles && (as_mesh || as_delta)) return refuse_angles_of_mesh(request);
    const std::size_t mesh_bytes = session.mesh_bytes();
    const auto memory =
        require_memory(services, request,
                       (dry_run ? mesh_bytes : 0) + (as_mesh ? bytes_to_encode(mesh_bytes) : 0));
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    if (!dry_run) {
        if (auto refusal = refusal_of_blind_edit(services, request, session)) return *refusal;
    }
    const Stopwatch watch;
    auto outcome = session.integrate(std::move(work->edit));
    if (const auto* mismatch = std::get_if<VersionMismatch>(&outcome)) {
        return version_mismatch(request, session, mismatch->current);
    }
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        return refuse(request, api::problem_of_errors(*errors, faults_of(*errors, work->shapes)));
    }
    const auto& result = std::get<PolygonResult>(outcome);
    services.metrics.edited(*result.report, watch.seconds(), dry_run);
    if (!dry_run && !services.sessions.is_kept(session)) {
        return refuse(request, api::ProblemType::NoSuchSession,
                      "The session was deleted while the edit ran: nothing of it is kept.");
    }
    begin_stage(1.0);
    Response response = as_mesh    ? mesh_after(services.metrics, request, session, result.version,
                                                result.mesh, dry_run, answer_type, std::get<0>(gltf))
                        : as_delta ? delta_response(services.metrics, request, session,
                                                    result.version, result.delta)
                                   : send_report(session, result, dry_run);
    if (!dry_run) response.with("Link", history_link(session, result.version));
    return response.with("ETag", session.etag(result.version)).with("Vary", "Accept");
}

Response list_polygons(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kFeatureTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    if (auto answer = answer_early(request, session, std::get<0>(type))) return *answer;
    const auto& [limit, after] = std::get<0>(page);
    const DrapedCopy copy = session.draped_after(polygon_number(after), limit);
    Response response =
        send_features(session, copy, std::get<0>(type),
                      api::write_feature_collection(copy.polygons, session.facts().crs));
    if (copy.more)
        response.with("Link", next_link(request, kCursorKind, limit, copy.polygons.back().id));
    return response;
}

Response get_polygon(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kFeatureTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const Session& session = *std::get<0>(found);
    const DrapedCopy copy = session.draped(arguments[1]);
    if (copy.polygons.empty()) return no_such_polygon(request, session, arguments[1]);
    if (auto answer = answer_early(request, session, std::get<0>(type))) return *answer;
    return send_features(session, copy, std::get<0>(type),
                         api::write_feature(copy.polygons.front(), session.facts().crs));
}

}  // namespace tinsmith::server
