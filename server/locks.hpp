// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "api/formats/delta.hpp"
#include "api/formats/locks_json.hpp"
#include "core/integrate/lock.hpp"
#include "core/integrate/shape.hpp"
#include "core/types/result.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// A locks request as it is run, and run again when what came before it changes.
struct LocksOperation {
    std::vector<core::Shape> shapes;  ///< the lines; rings as their borders
    double reach = 0.0;               ///< see core::lock_along
    bool locked = true;               ///< or unlocked
};

/// What came of one: a report for each path of each shape, in order.
struct LocksDone {
    bool locked = true;
    std::vector<core::LockReport> paths;
};

/// What a session is asked for.
struct LocksEdit {
    LocksOperation operation;
    bool dry_run = false;
    bool want_delta = false;                        ///< not of a dry run
    std::optional<std::uint64_t> expected_version;  ///< from If-Match
};

struct LocksResult {
    std::uint64_t version = 0;  ///< after the edit; unchanged by a dry run
    std::shared_ptr<const LocksDone> done;
    /// If it was wanted. Absent all the same where memory ran out after the edit was made.
    std::optional<api::MeshDelta> delta;
};

using LocksOutcome = std::variant<LocksResult, core::Errors, VersionMismatch>;

/// Some of the locked edges at one version, in order.
struct LockedCopy {
    std::vector<api::LockedEdge> edges;
    std::uint32_t last = 0;  ///< after which the next ones come
    std::uint64_t version = 0;
    bool more = false;  ///< others follow these
};

}  // namespace tinsmith::server
