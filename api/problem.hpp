// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "core/types/result.hpp"

namespace tinsmith::api {

/// Every way in which a request can fail. The word of each, its title and its HTTP status stand in
/// one table in problem.cpp; nowhere else is an error given a status number.
enum class ProblemType {
    BadRequest,            ///< the request's own form is broken
    KeyRequired,           ///< no API key, or none of this server's
    MalformedBody,         ///< the body is not the format it claims to be
    InvalidContent,        ///< well formed, but not something that can be done
    NotAvailable,          ///< a known wish that this version does not grant
    UnknownParameter,      ///< a query parameter or member nobody knows
    InvalidParameter,      ///< a known parameter with a value it cannot have
    UnsupportedMediaType,  ///< Content-Type
    UnsupportedEncoding,   ///< Content-Encoding
    NotAcceptable,         ///< Accept
    LengthRequired,
    BodyTooLarge,
    PathTooLong,
    TooManyHeaders,
    RangeRefused,
    ExpectationFailed,  ///< Expect
    RequestTimeout,
    NoSuchPath,
    NoSuchSession,
    NoSuchPolygon,
    OutsideMesh,  ///< the mesh has no surface at the position asked about
    MethodNotAllowed,
    VersionMismatch,       ///< If-Match
    PreconditionRequired,  ///< no If-Match where the operator wants one
    KeyReused,             ///< Idempotency-Key: another request had it
    KeyInUse,              ///< Idempotency-Key: its request is still running
    AnswerNotKept,         ///< Idempotency-Key: done before, but its answer was too large to keep
    EditRefused,           ///< the core refused: the place and reason are in errors[]
    BudgetExceeded,        ///< the work would pass a limit; errors[] names it
    IdTaken,               ///< the id of choice exists
    NothingToUndo,
    NothingToRedo,
    PolygonSettled,  ///< its operation is no longer kept: it is part of the base
    PolygonInUse,    ///< edits name it
    ReplayFailed,    ///< an operation that came later cannot be done without what goes
    NoSuchVersion,   ///< not yet
    VersionGone,     ///< no longer kept
    TooManySessions,
    TooManyRequests,  ///< of one API key, at the same time or in a second
    OutOfMemory,
    StorageUnavailable,   ///< the disk takes nothing now; nothing was changed
    SessionOutOfService,  ///< what is stored of it is damaged
    SessionReadOnly,      ///< it is kept as it is
    NoSuchJob,
    JobUnfinished,  ///< its result is asked for
    Stopped,        ///< the work was cancelled: time limit, shutdown, or its job was deleted
    TooManyJobs,
    Busy,
    NotReady,  ///< the server starts, stops, or lacks what it needs
    Internal,
};

/// What is answered instead of a result (RFC 9457).
struct Problem {
    ProblemType type = ProblemType::Internal;
    std::string detail;  ///< what happened and what to do about it
    Faults errors;       ///< all faults found, at most kMaxFaults are written
};

/// The stable word of a problem, "no-such-session"; its type is urn:tinsmith:problem:<word>.
std::string_view problem_word(ProblemType type);

/// What it is, in a few words: the same for every occurrence.
std::string_view problem_title(ProblemType type);

/// The HTTP status of a problem.
int problem_status(ProblemType type);

/// Every problem, in the order of the table.
std::span<const ProblemType> all_problems();

/// The problem of a word. Requires: one that the table has.
ProblemType problem_of_word(std::string_view word);

/// The problem that best says what an HTTP status says, for refusals made below the handlers.
ProblemType problem_of_status(int status);

/// The problem for what a reader found wrong with a body.
Problem problem_of_faults(FaultKind kind, Faults faults);

/// The problem for what the core refused. Requires: `faults` tell the same errors in the
/// caller's own places, one for one.
Problem problem_of_errors(const core::Errors& errors, Faults faults);

/// The body, application/problem+json. `instance` is the path of the request.
std::string write_problem(const Problem& problem, std::string_view instance,
                          std::string_view request_id);

inline constexpr std::string_view kProblemMediaType = "application/problem+json";

}  // namespace tinsmith::api
