// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "server/history.hpp"
#include "server/operation.hpp"

namespace tinsmith::server {

/// The operation that could not be run on what is now before it, and why.
struct ReplayFailure {
    std::uint64_t version = 0;
    core::Errors errors;
};

/// The limits of one of several operations that are run after another: its progress is a part of
/// theirs.
RunLimits limits_of_part(const RunLimits& limits, std::size_t index, std::size_t count);

using Replayed = std::variant<std::vector<AppliedPtr>, ReplayFailure>;

/// Runs operations one after the other. A failure leaves what was run before it in the mesh.
/// Requires: `find` knows the polygons of the operations before.
Replayed run_all(core::Tin& tin, std::span<const Rerun> wanted, const RunLimits& limits,
                 const PolygonFinder& find);

/// Takes the newest operations back and runs others in their place. A failure, or an exception,
/// leaves the mesh as it was. Requires: `taken` are the newest on the mesh, oldest first; `find`
/// knows the polygons of those before.
/// Cost: what was taken back and what is run; and a copy of the mesh where more than one of these
/// might have to be made undone.
Replayed replace_newest(core::Tin& tin, std::span<const AppliedPtr> taken,
                        std::span<const Rerun> wanted, const RunLimits& limits,
                        const PolygonFinder& find);

}  // namespace tinsmith::server
