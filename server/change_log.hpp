// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "core/mesh/tin.hpp"
#include "server/history.hpp"
#include "server/operation.hpp"

namespace tinsmith::server {

// What a session was asked for, whole enough to be asked for again at the version before.

struct PerformAsked {
    ChangeKind kind = ChangeKind::Polygons;
    OperationPtr operation;
    std::vector<std::string> polygons;  ///< that it brings or is about
};
struct UndoAsked {};
struct RedoAsked {};
struct RemovalAsked {
    std::string polygon;
    bool cascade = false;
};
using ChangeAsked = std::variant<PerformAsked, UndoAsked, RedoAsked, RemovalAsked>;

/// What listings tell of a session at one version.
struct SessionCounts {
    std::uint64_t version = 0;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    core::Bounds bounds;
    std::size_t polygons = 0;
    std::size_t memory_bytes = 0;
    std::size_t mesh_bytes = 0;
};

/// A change that the mesh has and nobody has been told of.
struct LoggedChange {
    const std::string& birth;  ///< of the session
    const ChangeAsked& asked;
    std::string digest;  ///< running: of all slots that this change and those before it wrote
    SessionCounts counts;
    double seconds = 0.0;  ///< that making it took
};

/// Nothing could be kept: the disk, not the request, is at fault, and nothing was changed.
class StorageFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The session is kept as it is and takes no changes.
class SessionIsReadOnly : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The session was removed while the change was made.
class SessionIsGone : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Keeps changes before anybody is told of them.
class ChangeLog {
  public:
    virtual ~ChangeLog() = default;
    /// Returns once the change is durable. Throws one of the above, or std::bad_alloc, where it is
    /// not; then it is not kept, and the session takes it back.
    virtual void keep(const LoggedChange& change) = 0;
};

}  // namespace tinsmith::server
