// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <variant>
#include <vector>

#include "api/responses.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::server {

/// What never changes about a session.
struct SessionFacts {
    std::string id;
    std::string birth;  ///< random, new each time an id is created: two lives never share an ETag
    std::string name;
    std::string crs;  ///< empty: unknown
    std::string unit;
};

/// A polygon that was integrated. Its id is never given to another.
struct Polygon {
    std::string id;
    std::string client_id;                       ///< the Feature's own; empty: none
    std::string properties;                      ///< the Feature's own, text of a JSON object
    std::shared_ptr<const core::Report> report;  ///< of the request that brought it
    std::size_t shape = 0;                       ///< its index there
};

/// The shapes of one request, and what each brings along (one for one with the shapes).
struct PolygonEdit {
    std::vector<core::Shape> shapes;
    std::vector<std::string> client_ids;
    std::vector<std::string> properties;
    core::IntegrateOptions options;
    bool dry_run = false;
    bool want_mesh = false;  ///< the answer shall hold the mesh that came of it
    std::optional<std::uint64_t> expected_version;  ///< from If-Match
    std::size_t max_triangles = SIZE_MAX;           ///< of the session after the edit
};

struct PolygonResult {
    std::uint64_t version = 0;  ///< after the edit; unchanged by a dry run
    std::vector<std::string> polygon_ids;
    std::shared_ptr<const core::Report> report;
    /// If it was wanted. Absent all the same where memory ran out after the edit was made.
    std::optional<core::MeshData> mesh;
};

struct VersionMismatch {
    std::uint64_t current = 0;
};

using PolygonOutcome = std::variant<PolygonResult, core::Errors, VersionMismatch>;

/// A mesh at one version, copied out so that it can be encoded while the session goes on.
struct MeshCopy {
    core::MeshData mesh;
    std::uint64_t version = 0;
};

/// One terrain in memory: its mesh, its version and its polygons.
///
/// Laws: one writer at a time, readers beside each other; an edit that fails leaves mesh, version
/// and polygons as they were; a version is never used twice; nothing is encoded under a lock.
class Session {
  public:
    Session(SessionFacts facts, core::Tin tin);

    /// A session of its own with all that this one has now: mesh, version, polygons and the ids to
    /// come. Takes the readers' lock for the time of a copy.
    std::shared_ptr<Session> fork(std::string id, std::string birth) const;

    const SessionFacts& facts() const { return facts_; }
    std::string etag(std::uint64_t version) const;

    /// As of the last finished edit: does not wait for one under way.
    api::SessionView view() const;
    MeshCopy copy_mesh() const;
    /// Integrates all shapes or none. A dry run works on a copy and holds no writer's lock.
    /// Requires: shapes, client_ids and properties of one length.
    PolygonOutcome integrate(PolygonEdit edit);

  private:
    PolygonOutcome integrate_dry(const PolygonEdit& edit) const;
    void keep_polygons(PolygonEdit& edit, const PolygonResult& result) noexcept;
    void refresh_view() noexcept;

    std::shared_lock<std::shared_mutex> lock_to_read() const;
    std::unique_lock<std::shared_mutex> lock_to_write() const;

    const SessionFacts facts_;
    mutable std::mutex turn_;  ///< held while waiting for the next, so that readers queue too
    mutable std::shared_mutex mutex_;  ///< guards mesh, version and polygons
    core::Tin tin_;
    std::uint64_t version_ = 1;
    std::uint64_t next_polygon_ = 1;
    std::size_t text_bytes_ = 0;  ///< of the polygons' properties and names
    std::vector<Polygon> polygons_;

    mutable std::mutex view_mutex_;  ///< guards the view; taken last and never held for long
    api::SessionView view_;
};

}  // namespace tinsmith::server
