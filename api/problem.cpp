// SPDX-License-Identifier: Apache-2.0
#include "api/problem.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include <nlohmann/json.hpp>

namespace tinsmith::api {

namespace {

/// A refused path may be of any length; its beginning tells enough.
constexpr std::size_t kLongestInstance = 512;

struct Row {
    ProblemType type;
    std::string_view word;
    std::string_view title;
    int status;
};

using enum ProblemType;

constexpr std::array kTable{
    Row{BadRequest, "bad-request", "The request is malformed", 400},
    Row{KeyRequired, "api-key-required", "An API key is required", 401},
    Row{MalformedBody, "malformed-body", "The body is not the format it claims to be", 400},
    Row{InvalidContent, "invalid-content", "The body cannot be used as it is", 422},
    Row{NotAvailable, "not-available", "Not available in this version", 422},
    Row{UnknownParameter, "unknown-parameter", "Unknown parameter", 400},
    Row{InvalidParameter, "invalid-parameter", "A parameter has a value it cannot have", 400},
    Row{UnsupportedMediaType, "unsupported-media-type", "Content-Type is not supported", 415},
    Row{UnsupportedEncoding, "unsupported-encoding", "Content-Encoding is not supported", 415},
    Row{NotAcceptable, "not-acceptable", "No answer in an accepted media type", 406},
    Row{LengthRequired, "length-required", "Content-Length is required", 411},
    Row{BodyTooLarge, "too-large", "The request is too large", 413},
    Row{PathTooLong, "path-too-long", "The path or query is too long", 414},
    Row{TooManyHeaders, "too-many-headers", "The head has too many or too long fields", 431},
    Row{RangeRefused, "range-refused", "The range cannot be served", 416},
    Row{ExpectationFailed, "expectation-failed", "The expectation cannot be met", 417},
    Row{RequestTimeout, "request-timeout", "The request did not arrive in time", 408},
    Row{NoSuchPath, "no-such-path", "Nothing is at this path", 404},
    Row{NoSuchSession, "no-such-session", "There is no such session", 404},
    Row{NoSuchPolygon, "no-such-polygon", "The session has no such polygon", 404},
    Row{OutsideMesh, "outside-mesh", "The mesh has no surface there", 404},
    Row{MethodNotAllowed, "method-not-allowed", "The method is not allowed here", 405},
    Row{VersionMismatch, "version-mismatch", "The session has another version", 412},
    Row{PreconditionRequired, "precondition-required", "If-Match is required", 428},
    Row{KeyReused, "key-reused", "The Idempotency-Key belongs to another request", 422},
    Row{KeyInUse, "key-in-use", "The request of this Idempotency-Key is still running", 409},
    Row{AnswerNotKept, "answer-not-kept", "Done before; the answer is not kept", 409},
    Row{EditRefused, "edit-refused", "The mesh cannot be edited this way", 422},
    Row{BudgetExceeded, "budget-exceeded", "The work would pass a limit", 422},
    Row{IdTaken, "id-taken", "The id is taken", 409},
    Row{NothingToUndo, "nothing-to-undo", "There is nothing to undo", 409},
    Row{NothingToRedo, "nothing-to-redo", "There is nothing to redo", 409},
    Row{PolygonSettled, "polygon-settled", "The polygon is too old to be taken out", 409},
    Row{PolygonInUse, "polygon-in-use", "Edits name the polygon", 409},
    Row{ReplayFailed, "replay-failed", "A later operation cannot be done again", 409},
    Row{NoSuchVersion, "no-such-version", "The session has no such version yet", 404},
    Row{VersionGone, "version-gone", "The version is no longer kept", 410},
    Row{TooManySessions, "too-many-sessions", "No room for another session", 429},
    Row{TooManyRequests, "too-many-requests", "Too many requests of this API key", 429},
    Row{OutOfMemory, "out-of-memory", "Not enough memory", 507},
    Row{StorageUnavailable, "storage-unavailable", "Nothing can be stored now", 503},
    Row{SessionOutOfService, "session-out-of-service", "The session cannot be read", 503},
    Row{SessionReadOnly, "session-read-only", "The session takes no changes", 409},
    Row{NoSuchJob, "no-such-job", "There is no such job", 404},
    Row{JobUnfinished, "job-unfinished", "The job has not ended yet", 409},
    Row{Stopped, "stopped", "The work was stopped", 503},
    Row{TooManyJobs, "too-many-jobs", "No room for another job", 503},
    Row{Busy, "busy", "The server has as many requests as it takes", 503},
    Row{NotReady, "not-ready", "The server is not ready", 503},
    Row{Internal, "internal", "The server failed", 500},
};

const Row& row_of(ProblemType type) {
    const auto* found = std::find_if(kTable.begin(), kTable.end(),
                                     [type](const Row& row) { return row.type == type; });
    return found == kTable.end() ? kTable.back() : *found;
}

constexpr std::string_view kAboutTime =
    " It may have taken longer than max_edit_seconds of /v1/limits, its job was deleted, or the "
    "server is stopping.";

ProblemType type_of_error(core::ErrorCode code) {
    switch (code) {
        case core::ErrorCode::MeshTooLarge:
            return BodyTooLarge;
        case core::ErrorCode::CrossingBudget:
        case core::ErrorCode::TriangleBudget:
        case core::ErrorCode::IdBudget:
        case core::ErrorCode::MemoryBudget:
            return BudgetExceeded;
        case core::ErrorCode::Cancelled:
            return Stopped;
        case core::ErrorCode::StepBudget:
            return Internal;
        default:
            return EditRefused;
    }
}

/// The limit that a fault has met, as /v1/limits calls it; empty: none that is anybody's to set.
std::string_view limit_met(std::string_view code) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kLimits{{
        {"TOO_MANY_VERTICES", "max_vertices"},
        {"TOO_MANY_TRIANGLES", "max_triangles"},
        {"TOO_MANY_POLYGON_VERTICES", "max_polygon_vertices"},
        {"TOO_MANY_POINTS", "max_points"},
        {"CROSSING_BUDGET", "max_crossings"},
        {"TRIANGLE_BUDGET", "max_triangles"},
        {"MEMORY_BUDGET", "max_session_bytes"},
    }};
    const auto* found = std::find_if(kLimits.begin(), kLimits.end(),
                                     [code](const auto& row) { return row.first == code; });
    return found == kLimits.end() ? std::string_view() : found->second;
}

/// Each names its limit, unless it is known better where it was made.
void name_limits(Faults& faults) {
    for (Fault& fault : faults)
        if (fault.limit.empty()) fault.limit = limit_met(fault.code);
}

/// A sentence about the first limit that was met.
std::string about_limit(const Faults& faults) {
    for (const Fault& fault : faults) {
        if (fault.limit.empty()) continue;
        return " (limit " + fault.limit + "; GET /v1/limits has its value)";
    }
    return {};
}

nlohmann::ordered_json json_of_fault(const Fault& fault) {
    nlohmann::ordered_json json{{"code", fault.code}, {"detail", fault.detail}};
    if (!fault.pointer.empty()) json["pointer"] = fault.pointer;
    if (!fault.parameter.empty()) json["parameter"] = fault.parameter;
    if (fault.coordinate) json["coordinate"] = {(*fault.coordinate)[0], (*fault.coordinate)[1]};
    if (fault.index) json["index"] = *fault.index;
    if (!fault.limit.empty()) json["limit"] = fault.limit;
    return json;
}

std::string summary_of(const Faults& faults) {
    if (faults.empty()) return {};
    if (faults.size() == 1) return faults.front().detail;
    const std::string count = faults.size() >= kMaxFaults ? "At least " + std::to_string(kMaxFaults)
                                                          : std::to_string(faults.size());
    return count + " faults, all in errors[]. The first: " + faults.front().detail;
}

}  // namespace

std::string_view problem_word(ProblemType type) {
    return row_of(type).word;
}

std::string_view problem_title(ProblemType type) {
    return row_of(type).title;
}

int problem_status(ProblemType type) {
    return row_of(type).status;
}

std::span<const ProblemType> all_problems() {
    static constexpr auto kTypes = [] {
        std::array<ProblemType, kTable.size()> types{};
        std::transform(kTable.begin(), kTable.end(), types.begin(),
                       [](const Row& row) { return row.type; });
        return types;
    }();
    return kTypes;
}

ProblemType problem_of_word(std::string_view word) {
    const auto* found = std::find_if(kTable.begin(), kTable.end(),
                                     [word](const Row& row) { return row.word == word; });
    assert(found != kTable.end());
    return found == kTable.end() ? Internal : found->type;
}

ProblemType problem_of_status(int status) {
    // Some statuses have several problems; the general one of each is the table's first.
    const auto* found = std::find_if(kTable.begin(), kTable.end(),
                                     [status](const Row& row) { return row.status == status; });
    if (found != kTable.end()) return found->type;
    return status < 500 ? BadRequest : Internal;
}

Problem problem_of_faults(FaultKind kind, Faults faults) {
    ProblemType type = InvalidContent;
    switch (kind) {
        case FaultKind::Syntax:
            type = MalformedBody;
            break;
        case FaultKind::Invalid:
            type = InvalidContent;
            break;
        case FaultKind::TooLarge:
            type = BodyTooLarge;
            break;
        case FaultKind::Unsupported:
            type = NotAvailable;
            break;
        case FaultKind::Parameter:
            type = InvalidParameter;
            break;
        case FaultKind::Stopped:
            type = Stopped;
            break;
    }
    name_limits(faults);
    std::string detail = summary_of(faults) + about_limit(faults);
    if (kind == FaultKind::Stopped) detail += kAboutTime;
    return {type, std::move(detail), std::move(faults)};
}

Problem problem_of_errors(const core::Errors& errors, Faults faults) {
    const ProblemType type = errors.empty() ? Internal : type_of_error(errors.front().code);
    name_limits(faults);
    std::string detail = summary_of(faults) + about_limit(faults);
    if (type == Stopped) {
        detail =
            "The edit ran longer than max_edit_seconds of /v1/limits, its job was deleted, or the "
            "server is stopping; the session is as it was. Send smaller parts, or try again.";
    }
    return {type, std::move(detail), std::move(faults)};
}

std::string write_problem(const Problem& problem, std::string_view instance,
                          std::string_view request_id) {
    const Row& row = row_of(problem.type);
    nlohmann::ordered_json json{
        {"type", "urn:tinsmith:problem:" + std::string(row.word)},
        {"title", row.title},
        {"status", row.status},
        {"detail", problem.detail},
        {"instance", instance.substr(0, kLongestInstance)},
        {"request_id", request_id},
    };
    if (!problem.errors.empty()) {
        auto& list = json["errors"] = nlohmann::ordered_json::array();
        const std::size_t count = std::min(problem.errors.size(), kMaxFaults);
        for (std::size_t i = 0; i < count; ++i)
            list.push_back(json_of_fault(problem.errors[i]));
    }
    // The client's own bytes may stand in detail and instance: what is not UTF-8 is replaced.
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tinsmith::api
