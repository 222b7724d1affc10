// SPDX-License-Identifier: Apache-2.0
// Edges that may not swap: locked and unlocked along lines, and listed.
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "api/formats/locks_json.hpp"
#include "api/media_type.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "lock";
constexpr std::array<std::string_view, 2> kAnswerTypes{kJson, kDelta};
constexpr std::array<std::string_view, 2> kFeatureTypes{kGeoJson, kJson};

struct Asked {
    std::shared_ptr<Session> session;
    LocksEdit edit;
    std::vector<api::RequestedShape> shapes;  ///< the way back to the body; their paths are gone
};

std::optional<Response> refusal_of_type(const Request& request) {
    const std::string type = api::media_type_of(request.header("content-type").value_or(""));
    if (type == "application/json" || type == "application/geo+json") return std::nullopt;
    return refuse_media_type(request, type, "lines", "application/geo+json, application/json",
                             "-H 'Content-Type: application/json'");
}

/// What the query and the body's `tinsmith` say: options of a polygons request.
std::vector<api::NamedOption> options_of(const Request& request, const api::PolygonRequest& lines) {
    auto given = options_of_query(request);
    for (const auto& [name, value] : lines.options)
        given.push_back({name, value, "/tinsmith/" + name});
    return given;
}

/// Reads those of them that mean something here.
api::Parsed<api::PolygonOptions> read_options(std::span<const api::NamedOption> given) {
    api::Faults faults;
    for (const auto& [name, value, pointer] : given) {
        if (std::ranges::find(kLockParameters, name) != kLockParameters.end()) continue;
        faults.push_back({"UNKNOWN_OPTION",
                          name + " is not known here; known are: snap, crs, dry_run.", pointer});
    }
    if (!faults.empty()) return {api::FaultKind::Invalid, std::move(faults)};
    return api::parse_polygon_options(given);
}

Response refuse_faults(const Request& request, api::FaultKind kind, api::Faults faults) {
    return refuse(request, api::problem_of_faults(kind, std::move(faults)));
}

Step<Asked> require_lines(const Services& services, const Request& request, Asked asked) {
    auto lines = api::read_lock_lines(request.body, services.read_limits(request.asker));
    if (!lines) {
        return refuse(request, api::problem_of_faults(lines.kind(), std::move(lines.faults())));
    }
    const auto given = options_of(request, *lines);
    auto options = read_options(given);
    if (!options) return refuse_faults(request, options.kind(), std::move(options.faults()));
    auto claim = claim_of(*lines, given);
    if (!claim) return refuse_faults(request, claim.kind(), std::move(claim.faults()));
    asked.edit.dry_run = options->dry_run;
    asked.edit.operation.reach = options->integrate.snap;
    for (api::RequestedShape& shape : lines->shapes)
        asked.edit.operation.shapes.push_back(std::move(shape.shape));
    asked.shapes = std::move(lines->shapes);
    auto misplaced = api::bring_into(asked.session->facts().crs, *claim,
                                     asked.edit.operation.shapes, asked.shapes, api::kMaxFaults);
    if (!misplaced.empty())
        return refuse_faults(request, api::FaultKind::Invalid, std::move(misplaced));
    return asked;
}

Step<Asked> require_locks(const Services& services, const Request& request, Asked asked) {
    if (auto refusal = refusal_of_type(request)) return *refusal;
    const auto type = require_media_type(request, kAnswerTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto expected = require_if_match(request, *asked.session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;
    asked.edit.expected_version = std::get<0>(expected);
    asked.edit.want_delta = std::get<0>(type) == 1;
    auto read = require_lines(services, request, std::move(asked));
    if (const auto* refusal = std::get_if<Response>(&read)) return *refusal;
    const LocksEdit& edit = std::get<0>(read).edit;
    if (edit.dry_run && edit.want_delta) {
        return refuse(request, api::ProblemType::InvalidParameter,
                      "A dry run makes no version that a delta could lead to: leave dry_run out, "
                      "or ask for application/json.");
    }
    if (!edit.dry_run) {
        if (auto refusal = refusal_of_blind_edit(services, request, *std::get<0>(read).session)) {
            return *refusal;
        }
    }
    return read;
}

Response set_locks(Services& services, const Request& request, const std::string& id, bool locked) {
    auto found = require_session(services, request, id);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    Asked blank{std::move(std::get<0>(found)), {}, {}};
    blank.edit.operation.locked = locked;
    auto asked = require_locks(services, request, std::move(blank));
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    auto& [session, edit, shapes] = std::get<0>(asked);
    const bool dry_run = edit.dry_run;
    const bool as_delta = edit.want_delta;
    const auto memory = require_memory(services, request, dry_run ? session->mesh_bytes() : 0);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    RunLimits limits = rerun_limits(services.limits_of(request.asker), services.stopping);
    limits.max_crossings = services.limits_of(request.asker).max_crossings;
    const Stopwatch watch;
    const auto outcome = session->set_locks(std::move(edit), std::move(limits));
    if (const auto* mismatch = std::get_if<VersionMismatch>(&outcome)) {
        return version_mismatch(request, *session, mismatch->current);
    }
    if (const auto* errors = std::get_if<core::Errors>(&outcome)) {
        return refuse(request, api::problem_of_errors(*errors, faults_of(*errors, shapes)));
    }
    services.metrics.edited(EditSort::Locks, watch.seconds(), dry_run);
    if (!dry_run && !services.sessions.is_kept(*session))
        return no_such_session(services, request, id);
    const auto& result = std::get<LocksResult>(outcome);
    Response response =
        as_delta ? delta_response(services.metrics, request, *session, result.version, result.delta)
                 : ok(kJson,
                      api::write_locks({id, result.version, dry_run, locked, result.done->paths}));
    if (!dry_run) response.with("Link", history_link(*session, result.version));
    return response.with("ETag", session->etag(result.version)).with("Vary", "Accept");
}

/// The number after which a page begins; none: the list's first page.
std::optional<std::uint32_t> number_in(const std::string& after) {
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(after.data(), after.data() + after.size(), number);
    return error == std::errc() && !after.empty() ? std::optional(number) : std::nullopt;
}

}  // namespace

Response put_locks(Services& services, const Request& request, const PathArguments& arguments) {
    return set_locks(services, request, arguments[0], true);
}

Response delete_locks(Services& services, const Request& request, const PathArguments& arguments) {
    return set_locks(services, request, arguments[0], false);
}

Response get_locks(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kFeatureTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    const std::string_view suffix = std::get<0>(type) == 0 ? "-locks-geojson" : "-locks-json";
    if (auto answer = answer_to_conditions(request, session, session.view().version, suffix)) {
        return answer->with("Vary", "Accept");
    }
    const auto& [limit, after] = std::get<0>(page);
    const LockedCopy copy = session.locked_after(number_in(after), limit);
    Response response = ok(std::string(kFeatureTypes[std::get<0>(type)]),
                           api::write_locked_edges(copy.edges, session.facts().crs));
    if (copy.more) {
        response.with("Link", next_link(request, kCursorKind, limit, std::to_string(copy.last)));
    }
    return response.with("ETag", etag_of(session, copy.version, suffix)).with("Vary", "Accept");
}

}  // namespace tinsmith::server
