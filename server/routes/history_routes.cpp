// SPDX-License-Identifier: Apache-2.0
// Back and forth: undo, redo, polygons taken out, and what is told of the past.
#include <array>
#include <utility>

#include "api/edit_answer.hpp"
#include "api/formats/locks_json.hpp"
#include "api/history.hpp"
#include "api/responses.hpp"
#include "server/polygon_reading.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "change";
constexpr std::array<std::string_view, 2> kAnswerTypes{kJson, kDelta};

/// What is asked of a session, ready to be asked.
struct Asked {
    std::shared_ptr<Session> session;
    ChangeRequest change;
};

Step<Asked> require_change(Services& services, const Request& request, const std::string& id) {
    auto found = require_session(services, request, id);
    if (auto* refusal = std::get_if<Response>(&found)) return std::move(*refusal);
    Asked asked{std::move(std::get<0>(found)), {}};
    if (!request.body.empty()) {
        return refuse(request, api::ProblemType::BadRequest,
                      "There is no body here: leave it out.");
    }
    const auto type = require_media_type(request, kAnswerTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto expected = require_if_match(request, *asked.session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;
    if (auto refusal = refusal_of_blind_edit(services, request, *asked.session)) return *refusal;
    asked.change.expected_version = std::get<0>(expected);
    asked.change.want_delta = std::get<0>(type) == 1;
    begin_stage(1.0);
    asked.change.limits = rerun_limits(services.limits_of(request.asker), services.stopping);
    return asked;
}

Response refuse_replay(const Request& request, const ReplayFailure& failure) {
    api::Faults faults = faults_of(failure.errors, {});
    if (failure.errors.front().code == core::ErrorCode::Cancelled) {
        return refuse(request, api::problem_of_errors(failure.errors, std::move(faults)));
    }
    std::string detail =
        "The operation of version " + std::to_string(failure.version) +
        " cannot be done again on what would be left: " + failure.errors.front().detail +
        ". Nothing was changed; undo that operation or take its polygons out "
        "first.";
    return refuse(request, {api::ProblemType::ReplayFailed, std::move(detail), std::move(faults)});
}

std::string listed(const std::vector<std::uint64_t>& versions) {
    std::string text;
    for (const std::uint64_t version : versions)
        text += (text.empty() ? "" : ", ") + std::to_string(version);
    return text;
}

Response refuse_polygon(const Request& request, const Session& session,
                        const ChangeOutcome& outcome, const std::string& id) {
    if (std::holds_alternative<PolygonSettled>(outcome)) {
        return refuse(request, api::ProblemType::PolygonSettled,
                      "The session no longer keeps the operation that brought this polygon: only "
                      "the newest max_history operations can be taken out.");
    }
    if (const auto* users = std::get_if<PolygonInUse>(&outcome)) {
        return refuse(request, api::ProblemType::PolygonInUse,
                      "The edits of these versions name the polygon: " + listed(users->versions) +
                          ". Take them back first, or repeat with cascade=true and they go too.");
    }
    return no_such_polygon(request, session, id);
}

/// What a change was and how long it took.
struct Timed {
    EditSort sort;
    double seconds;
};

Response send_change(const Request& request, Services& services, const Asked& asked,
                     const ChangeOutcome& outcome, api::ProblemType nothing, Timed timed) {
    const Session& session = *asked.session;
    if (const auto* mismatch = std::get_if<VersionMismatch>(&outcome)) {
        return version_mismatch(request, session, mismatch->current);
    }
    if (std::holds_alternative<NothingToDo>(outcome)) {
        return refuse(request, nothing,
                      "GET /v1/sessions/" + session.facts().id +
                          "/history says what can be taken back and what can be made again.");
    }
    if (const auto* failure = std::get_if<ReplayFailure>(&outcome)) {
        return refuse_replay(request, *failure);
    }
    services.metrics.edited(timed.sort, timed.seconds);
    if (!services.sessions.is_kept(session))
        return no_such_session(services, request, session.facts().id);
    const auto& result = std::get<ChangeResult>(outcome);
    const std::uint64_t version = result.change.view.version;
    Response response =
        asked.change.want_delta
            ? delta_response(services.metrics, request, session, version, result.delta)
            : ok(kJson, api::write_change(session.facts().id, result.change.view));
    return response.with("ETag", session.etag(version))
        .with("Link", history_link(session, version))
        .with("Vary", "Accept");
}

/// A request's own report again; of another change what is told of it.
std::string text_of(const Session& session, const ChangeCopy& change) {
    if (change.answer) {
        return api::write_edit(session.facts().id, change.view.version, false, *change.answer);
    }
    if (change.locks) {
        return api::write_locks({session.facts().id, change.view.version, false,
                                 change.locks->locked, change.locks->paths});
    }
    if (!change.report) return api::write_change(session.facts().id, change.view);
    return api::write_report(
        {session.facts().id, change.view.version, false, change.view.polygons, *change.report});
}

}  // namespace

Response undo_edit(Services& services, const Request& request, const PathArguments& arguments) {
    const auto asked = require_change(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const Asked& what = std::get<0>(asked);
    const Stopwatch watch;
    const auto outcome = what.session->undo(what.change);
    return send_change(request, services, what, outcome, api::ProblemType::NothingToUndo,
                       {EditSort::Undo, watch.seconds()});
}

Response redo_edit(Services& services, const Request& request, const PathArguments& arguments) {
    const auto asked = require_change(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const Asked& what = std::get<0>(asked);
    const Stopwatch watch;
    const auto outcome = what.session->redo(what.change);
    return send_change(request, services, what, outcome, api::ProblemType::NothingToRedo,
                       {EditSort::Redo, watch.seconds()});
}

Response delete_polygon(Services& services, const Request& request,
                        const PathArguments& arguments) {
    const auto asked = require_change(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const auto cascade = require_flag(request, "cascade");
    if (const auto* refusal = std::get_if<Response>(&cascade)) return *refusal;
    const Asked& what = std::get<0>(asked);
    const Stopwatch watch;
    const auto outcome =
        what.session->remove_polygon(arguments[1], std::get<0>(cascade), what.change);
    const bool is_about_polygon = std::holds_alternative<NoSuchPolygon>(outcome) ||
                                  std::holds_alternative<PolygonSettled>(outcome) ||
                                  std::holds_alternative<PolygonInUse>(outcome);
    if (is_about_polygon) return refuse_polygon(request, *what.session, outcome, arguments[1]);
    return send_change(request, services, what, outcome, api::ProblemType::NothingToUndo,
                       {EditSort::Removal, watch.seconds()});
}

Response get_history(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    const auto& [limit, after] = std::get<0>(page);
    const HistoryCopy copy = session.history(parse_version(after).value_or(0), limit);
    Response response = ok(kJson, api::write_history({session.facts().id, copy.version, copy.oldest,
                                                      copy.undo, copy.redo, copy.changes}));
    if (copy.more) {
        const std::string last = std::to_string(copy.changes.back().version);
        response.with("Link", next_link(request, kCursorKind, limit, last));
    }
    return response.with("ETag", etag_of(session, copy.version, "-history"));
}

Response get_change(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    const auto version = parse_version(arguments[1]);
    const auto copy = session.change_at(version.value_or(0) == 0 ? UINT64_MAX : *version);
    if (const auto* gone = std::get_if<VersionGone>(&copy)) {
        return version_gone(request, session, *gone);
    }
    if (const auto* ahead = std::get_if<VersionAhead>(&copy)) {
        return version_ahead(request, *ahead);
    }
    return ok(kJson, text_of(session, std::get<ChangeCopy>(copy)));
}

Response tell_change(const Session& session, const ChangeCopy& change) {
    const std::uint64_t version = change.view.version;
    return ok(kJson, text_of(session, change))
        .with("Link", history_link(session, version))
        .with("ETag", session.etag(version))
        .with("Vary", "Accept");
}

}  // namespace tinsmith::server
