// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/geojson_writer.hpp"
#include "api/responses.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// What never changes about a session.
struct SessionFacts {
    std::string id;
    std::string birth;  ///< random, new each time an id is created: two lives never share an ETag
    std::string name;
    std::string crs;  ///< empty: unknown
    std::string unit;
};

/// A mesh at one version, copied out so that it can be encoded while the session goes on.
struct MeshCopy {
    core::MeshData mesh;
    std::uint64_t version = 0;
};

/// Polygons at one version, copied out in the same way.
struct DrapedCopy {
    std::vector<api::DrapedPolygon> polygons;
    std::uint64_t version = 0;
    bool more = false;  ///< others follow these
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
    /// All polygons, or the one of that id, as they lie in the mesh now; no polygon where none has
    /// it. Holds the readers' lock while their regions are found.
    DrapedCopy draped(std::optional<std::string_view> id = {}) const;
    /// The same for at most `limit` polygons, those that came after p`number`.
    DrapedCopy draped_after(std::uint64_t number, std::size_t limit) const;
    /// Integrates all shapes or none. A dry run works on a copy and holds no writer's lock.
    /// Requires: shapes and origins of one length.
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
    std::size_t polygon_bytes_ = 0;  ///< of all that is kept of the polygons beside the mesh
    std::vector<Polygon> polygons_;

    mutable std::mutex view_mutex_;  ///< guards the view; taken last and never held for long
    api::SessionView view_;
};

}  // namespace tinsmith::server
