// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "api/answers.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/media_type.hpp"
#include "server/polygon_reading.hpp"
#include "server/questions.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

api::AnswerHead head_of(const Session& session, std::uint64_t version) {
    return {session.facts().id, version, session.facts().unit};
}

Response answer(const Session& session, std::uint64_t version, std::string body) {
    return ok(kJson, std::move(body)).with("ETag", session.etag(version));
}

std::optional<Response> refusal_of_type(const Request& request, std::string_view what) {
    const std::string type = api::media_type_of(request.header("content-type").value_or(""));
    if (type == "application/json" || type == "application/geo+json") return std::nullopt;
    return refuse_media_type(request, type, what, "application/json, application/geo+json",
                             "-H 'Content-Type: application/json'");
}

Response refuse_faults(const Request& request, api::FaultKind kind, api::Faults faults) {
    return refuse(request, api::problem_of_faults(kind, std::move(faults)));
}

/// A coordinate from the query, or a fault.
double read_coordinate(const Request& request, const std::string& name, api::Faults& faults) {
    const auto text = request.parameter(name);
    double value = 0.0;
    if (text) {
        const char* end = text->data() + text->size();
        const auto [stop, error] = std::from_chars(text->data(), end, value);
        if (error == std::errc() && stop == end && api::json::acceptable_coordinate(value))
            return value;
    }
    api::Fault fault{text ? "INVALID_OPTION" : "OPTION_MISSING",
                     name + (text ? " cannot be \"" + std::string(*text) + "\"" : " is missing") +
                         ": give a coordinate in the session's system, such as " + name +
                         "=736500.5.",
                     {}};
    fault.parameter = name;
    faults.push_back(std::move(fault));
    return 0.0;
}

/// The query's crs, which may be missing.
api::Parsed<api::PolygonOptions> read_crs_option(const Request& request) {
    const auto crs = request.parameter("crs");
    std::vector<api::NamedOption> given;
    if (crs) given.push_back({"crs", std::string(*crs), {}});
    return api::parse_polygon_options(given);
}

api::Faults bring_into(const Session& session, const api::CrsClaim& claim,
                       std::span<core::Point2> points) {
    return api::bring_into(session.facts().crs, claim, points, "/points", api::kMaxFaults);
}

/// The other session of a volume request, null where it names none.
Step<std::shared_ptr<Session>> require_other(Services& services, const Request& request,
                                             const Session& session,
                                             const api::VolumeRequest& asked) {
    const auto* named = std::get_if<api::OtherSession>(&asked.against);
    if (named == nullptr) return std::shared_ptr<Session>();
    auto other = services.sessions.find(named->id, request.asker);
    const std::string pointer = "/against/session";
    if (!other) {
        std::string detail = "No session has the id \"" + named->id.substr(0, 64) +
                             "\". GET /v1/sessions lists them.";
        return refuse(request, api::Problem{api::ProblemType::NoSuchSession,
                                            detail,
                                            {{"NO_SUCH_SESSION", detail, pointer}}});
    }
    const SessionFacts &ours = session.facts(), &theirs = other->facts();
    const bool same_crs = ours.crs.empty() || theirs.crs.empty() || ours.crs == theirs.crs;
    if (same_crs && ours.unit == theirs.unit) return other;
    return refuse_faults(request, api::FaultKind::Invalid,
                         {{"CRS_MISMATCH",
                           "The other session is in " +
                               (theirs.crs.empty() ? std::string("no named system") : theirs.crs) +
                               " and " + theirs.unit + ", this one in " +
                               (ours.crs.empty() ? std::string("no named system") : ours.crs) +
                               " and " + ours.unit + ": compare surfaces of one system.",
                           pointer}});
}

}  // namespace

Response get_elevation(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    api::Faults faults;
    const double x = read_coordinate(request, "x", faults);
    const double y = read_coordinate(request, "y", faults);
    auto options = read_crs_option(request);
    if (!options) std::ranges::move(options.faults(), std::back_inserter(faults));
    if (!faults.empty()) {
        return refuse_faults(request, api::FaultKind::Parameter, std::move(faults));
    }
    std::array<core::Point2, 1> place{{{x, y}}};
    if (auto misplaced = bring_into(session, {options->crs, {}}, place); !misplaced.empty()) {
        misplaced.front().pointer.clear();  // it stands in the query
        misplaced.front().parameter = "crs";
        return refuse_faults(request, api::FaultKind::Parameter, std::move(misplaced));
    }
    const SpotAnswer found_spot = spot_in(session, place[0]);
    if (!found_spot.spot) {
        return refuse(request, api::ProblemType::OutsideMesh,
                      "The position is outside the mesh, or in a hole of it. Its bounds are in GET "
                      "/v1/sessions/" +
                          session.facts().id + ".")
            .with("ETag", session.etag(found_spot.version));
    }
    return answer(session, found_spot.version,
                  api::write_elevation(head_of(session, found_spot.version), place[0],
                                       *found_spot.spot, found_spot.polygons));
}

Response ask_elevations(Services& services, const Request& request,
                        const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    if (auto refusal = refusal_of_type(request, "points")) return *refusal;
    api::ReadLimits limits = services.read_limits(request.asker);
    limits.max_polygon_vertices = services.limits_of(request.asker).max_points;
    auto points = api::read_points(request.body, limits);
    if (!points) return refuse_faults(request, points.kind(), std::move(points.faults()));
    auto options = read_crs_option(request);
    if (!options) return refuse_faults(request, options.kind(), std::move(options.faults()));
    if (auto misplaced = bring_into(session, {options->crs, {}}, *points); !misplaced.empty())
        return refuse_faults(request, api::FaultKind::Invalid, std::move(misplaced));
    const SpotsAnswer spots = spots_in(session, *points);
    return answer(session, spots.version,
                  api::write_elevations(
                      head_of(session, spots.version), spots.spots,
                      options->crs.empty() ? std::span<const core::Point2>{} : std::span{*points}));
}

Response ask_profile(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    if (auto refusal = refusal_of_type(request, "a line")) return *refusal;
    auto line = api::read_line(request.body, services.read_limits(request.asker));
    if (!line) return refuse_faults(request, line.kind(), std::move(line.faults()));
    auto options = read_crs_option(request);
    if (!options) return refuse_faults(request, options.kind(), std::move(options.faults()));
    auto claim = claim_of(*line, options_of_query(request));
    if (!claim) return refuse_faults(request, claim.kind(), std::move(claim.faults()));
    std::array<core::Shape, 1> shapes{std::move(line->shapes.front().shape)};
    if (auto misplaced =
            api::bring_into(session.facts().crs, *claim, shapes, line->shapes, api::kMaxFaults);
        !misplaced.empty()) {
        return refuse_faults(request, api::FaultKind::Invalid, std::move(misplaced));
    }
    const Limits limits = services.limits_of(request.asker);
    const bool is_own = limits.max_profile_crossings < limits.max_crossings;
    const auto outcome = profile_in(session, shapes[0].paths.front().points,
                                    {std::min(limits.max_crossings, limits.max_profile_crossings),
                                     deadline(limits, services.stopping)});
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        return refuse_question(request, *errors, line->shapes,
                               is_own ? "max_profile_crossings" : "");
    }
    const auto& [profile, version] = std::get<ProfileAnswer>(outcome);
    return answer(session, version, api::write_profile(head_of(session, version), profile));
}

Response ask_volume(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    if (auto refusal = refusal_of_type(request, "a question")) return *refusal;
    if (auto refusal = refusal_of_memory(services, request)) return *refusal;
    begin_stage(0.1);
    auto asked = api::read_volume_request(request.body, services.read_limits(request.asker));
    if (!asked) return refuse_faults(request, asked.kind(), std::move(asked.faults()));
    const auto other = require_other(services, request, session, *asked);
    if (const auto* refusal = std::get_if<Response>(&other)) return *refusal;
    const Session* theirs = std::get<0>(other).get();
    const auto memory = require_memory(services, request, volume_bytes(session, *asked, theirs));
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const auto outcome =
        volume_in(session, *asked, theirs, services.limits_of(request.asker), services.stopping);
    if (const auto* gone = std::get_if<VersionGone>(&outcome)) {
        return version_gone(request, session, *gone);
    }
    if (const auto* ahead = std::get_if<VersionAhead>(&outcome)) {
        return version_ahead(request, *ahead);
    }
    if (const auto* fault = std::get_if<PolygonFault>(&outcome)) {
        return refuse_polygon(request, asked->polygon_id, *fault);
    }
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        std::vector<api::RequestedShape> shapes;
        if (asked->shape) shapes.push_back(*std::move(asked->shape));
        return refuse_question(request, *errors, shapes);
    }
    const VolumeAnswer& volume = std::get<VolumeAnswer>(outcome);
    return answer(
        session, volume.version,
        api::write_volume({head_of(session, volume.version), volume.volume, volume.area_left_out,
                           asked->polygon_id, asked->against, volume.other_version}));
}

}  // namespace tinsmith::server
