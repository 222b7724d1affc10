// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/build.hpp"
#include "server/edit_making.hpp"
#include "server/session.hpp"
#include "tests/support/random_input.hpp"

namespace tinsmith::test {

/// Requests of every kind, at random, to a session on a random mesh.
class RandomWork {
  public:
    explicit RandomWork(std::uint64_t seed) : random_(seed) {
        const auto kind = static_cast<MeshKind>(pick(random_, kMeshKinds));
        while (mesh_.triangles.empty())
            mesh_ = random_mesh(random_, kind, 2 + pick(random_, 5));
    }

    std::shared_ptr<server::Session> make_session(server::HistoryLimits limits = {}) const {
        return std::make_shared<server::Session>(
            server::SessionFacts{"s", "b", "Random", "EPSG:32616", "metre"},
            std::move(core::build_tin(mesh_).value()), limits);
    }

    /// One request, which may well be refused. The same again after a copy of this.
    void ask(server::Session& session) {
        switch (pick(random_, 10)) {
            case 0:
                session.undo({});
                break;
            case 1:
                session.redo({});
                break;
            case 2:
                session.remove_polygon(some_polygon(session), pick(random_, 2) == 0, {});
                break;
            case 3:
            case 4:
                edit(session);
                break;
            case 5:
                lock(session);
                break;
            default:
                integrate(session);
        }
    }

  private:
    std::string some_polygon(const server::Session& session) {
        const auto drawn = session.draped();
        if (drawn.polygons.empty()) return "p99";
        const auto which = static_cast<std::size_t>(random_() % drawn.polygons.size());
        return drawn.polygons[which].id;
    }
    core::Shape shape() {
        const auto kind = static_cast<ShapeKind>(pick(random_, kShapeKinds));
        core::Shape made = random_shape(random_, kind, mesh_);
        if (pick(random_, 4) == 0) give_elevations(random_, made, mesh_);
        return made;
    }
    void integrate(server::Session& session) {
        server::PolygonEdit edit;
        const int count = 1 + pick(random_, 3);
        for (int i = 0; i < count; ++i) {
            edit.shapes.push_back(shape());
            edit.origins.push_back({"7", R"({"a": 1})", api::GeometryType::Polygon, 1, {0}});
        }
        edit.options.improve = pick(random_, 2) == 0 ? core::Improve::Strict : core::Improve::None;
        session.integrate(std::move(edit));
    }
    void edit(server::Session& session) {
        api::EditRequest request;
        request.operation = static_cast<api::EditKind>(pick(random_, 5));
        request.polygon = some_polygon(session);
        request.plane = core::level_plane(uniform(random_, -5, 5));
        request.by = uniform(random_, -1, 1);
        request.passes = 1 + random_() % 4;
        request.moves_border = pick(random_, 3) == 0;
        const bool is_raising =
            request.operation == api::EditKind::Set || request.operation == api::EditKind::Offset;
        if (is_raising && !request.moves_border) request.rim = 0.001;
        auto made = server::make_edit(session, request, server::Limits{}, never_);
        if (auto* pending = std::get_if<server::PendingEdit>(&made))
            session.edit(std::move(*pending));
    }
    void lock(server::Session& session) {
        server::LocksEdit edit;
        edit.operation.shapes.push_back(random_shape(random_, ShapeKind::AlongEdges, mesh_));
        edit.operation.locked = pick(random_, 3) != 0;
        session.set_locks(std::move(edit), {});
    }

    static inline const std::atomic<bool> never_{false};
    Random random_;
    core::MeshData mesh_;
};

}  // namespace tinsmith::test
