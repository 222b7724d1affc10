// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "api/edit_answer.hpp"
#include "api/formats/delta.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"
#include "server/operation.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// An edit, ready to be made.
struct PendingEdit {
    EditOperation operation;
    RunLimits limits = {};
    SessionSize most = {};  ///< of the session after the edit
    bool dry_run = false;
    bool want_mesh = false;   ///< the answer shall hold the mesh that came of it
    bool want_delta = false;  ///< the answer shall hold what changed; not of a dry run
    std::optional<std::uint64_t> expected_version = {};  ///< from If-Match
};

struct EditResult {
    std::uint64_t version = 0;  ///< after the edit; unchanged by a dry run
    std::shared_ptr<const api::EditAnswer> answer;
    /// If it was wanted. Absent all the same where memory ran out after the edit was made.
    std::optional<core::MeshData> mesh;
    std::optional<api::MeshDelta> delta;  ///< likewise
};

/// What names a polygon that the session has not, or that has no inside.
enum class PolygonFault { NotThere, NoInside };

using EditOutcome = std::variant<EditResult, core::Errors, VersionMismatch, PolygonFault>;

}  // namespace tinsmith::server
