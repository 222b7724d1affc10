// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/mesh/tin.hpp"
#include "server/operation.hpp"

namespace tinsmith::server {

/// A digest of all vertices and triangles with neighbours, facets and marks. Cost: the mesh.
std::string whole_digest(const core::Tin& tin);

/// The running digest after a change: of the one before it, and of what the mesh holds now in each
/// slot that the change wrote. Two sessions that were changed in the same way have the same one.
/// Requires: `taken` were taken back and then `done` were run, newest on the mesh.
/// Cost: what was written.
std::string next_digest(const std::string& before, std::uint64_t version, const core::Tin& tin,
                        std::span<const AppliedPtr> taken, std::span<const AppliedPtr> done);

}  // namespace tinsmith::server
