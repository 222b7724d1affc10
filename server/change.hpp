// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/delta.hpp"
#include "api/history.hpp"
#include "core/integrate/report.hpp"
#include "server/operation.hpp"
#include "server/polygon.hpp"
#include "server/replay.hpp"

namespace tinsmith::server {

/// What undo, redo and the removal of a polygon are asked with.
struct ChangeRequest {
    std::optional<std::uint64_t> expected_version = {};  ///< from If-Match
    bool want_delta = false;
    RunLimits limits = {};  ///< of what has to be run again
};

/// Whether a request that expects a version, if it does, expects this one.
template <typename Asked>
bool is_expected(const Asked& asked, std::uint64_t version) {
    return !asked.expected_version || *asked.expected_version == version;
}

/// The limits of a run, tightened to what a session of that size may still grow by.
RunLimits tightened(RunLimits limits, const SessionSize& now, const SessionSize& most);

/// What a run said, where memory is what allowed no more triangles: that.
core::Errors named_by(const RunLimits& limits, core::Errors errors);

/// How a version came about, copied out.
struct ChangeCopy {
    api::ChangeView view;
    std::shared_ptr<const core::Report> report;     ///< of a polygons request, else null
    std::shared_ptr<const LocksDone> locks;         ///< of a locks request, else null
    std::shared_ptr<const api::EditAnswer> answer;  ///< of an edit, else null
};

struct ChangeResult {
    ChangeCopy change;
    /// If it was wanted. Absent all the same where memory ran out after the change was made.
    std::optional<api::MeshDelta> delta;
};

/// All edits are taken back, or none is.
struct NothingToDo {};

struct NoSuchPolygon {};

/// The polygon's operation is older than what the session keeps: it is part of the base.
struct PolygonSettled {};

/// Edits work on the polygon; the versions that they made.
struct PolygonInUse {
    std::vector<std::uint64_t> versions;
};

using ChangeOutcome = std::variant<ChangeResult, VersionMismatch, NothingToDo, NoSuchPolygon,
                                   PolygonSettled, PolygonInUse, ReplayFailure>;

/// The version does not exist yet.
struct VersionAhead {
    std::uint64_t current = 0;
};

/// The history, or a part of it, copied out.
struct HistoryCopy {
    std::uint64_t version = 0;
    std::uint64_t oldest = 0;           ///< of all that is kept
    std::optional<std::uint64_t> undo;  ///< the version that undo would take back
    std::optional<std::uint64_t> redo;  ///< the version whose edit redo would do again
    std::vector<api::ChangeView> changes;
    bool more = false;  ///< others follow these
};

}  // namespace tinsmith::server
