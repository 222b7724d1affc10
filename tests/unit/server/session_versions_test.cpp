// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "server/session.hpp"
#include "tests/support/same_tin.hpp"

namespace tinsmith::server {
namespace {

Session make_session(HistoryLimits limits = {}) {
    core::MeshData data;
    data.vertices = {{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, 3}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    return Session({"s", "b", "Square", "", "metre"}, std::move(core::build_tin(data).value()),
                   limits);
}

/// A square from corner to corner.
PolygonEdit square_edit(double low, double high) {
    PolygonEdit edit;
    edit.shapes.push_back({{{{{low, low}, {high, low}, {high, high}, {low, high}}, true}}});
    edit.origins.resize(1);
    return edit;
}

TEST(SessionVersions, KeepsVersionsWithinItsBytes) {
    HistoryLimits limits;
    limits.bytes = 20'000;
    Session s = make_session(limits);
    // Each edit is undone and replaced: what it was is kept for the sake of its version alone.
    for (int i = 0; i < 200; ++i) {
        s.integrate(square_edit(1 + i * 0.01, 4 + i * 0.02));
        s.undo({});
        ASSERT_LE(s.view().memory_bytes, s.mesh_bytes() + 2 * limits.bytes);
    }
    const auto gone = std::get<VersionGone>(s.missing(2));
    EXPECT_GT(gone.oldest, 2U);
    EXPECT_LT(gone.oldest, s.view().version) << "some are kept";
    for (std::uint64_t version = 1; version <= s.view().version; ++version)
        EXPECT_EQ(std::holds_alternative<VersionGone>(s.missing(version)), version < gone.oldest);
    EXPECT_TRUE(std::holds_alternative<core::Tin>(s.tin_at(gone.oldest, {})));
}

TEST(SessionVersions, SettlesLocksForNothing) {
    HistoryLimits limits;
    limits.bytes = 40'000;
    Session s = make_session(limits);
    for (int i = 0; i < 1500; ++i) {
        LocksEdit edit;
        edit.operation.shapes.push_back({{{{{0, 0}, {10, 0}}, false}}});
        edit.operation.locked = i % 2 == 0;
        ASSERT_TRUE(std::holds_alternative<LocksResult>(s.set_locks(std::move(edit), {})));
    }
    ASSERT_LE(s.view().memory_bytes, s.mesh_bytes() + limits.bytes);
    int undone = 0;
    while (std::holds_alternative<ChangeResult>(s.undo({})))
        ++undone;
    EXPECT_GT(undone, 5) << "what is settled takes nothing away";
}

TEST(SessionVersions, BoundsWhatChangesTell) {
    HistoryLimits limits;
    limits.bytes = 40'000;
    Session s = make_session(limits);
    ASSERT_TRUE(std::holds_alternative<PolygonResult>(s.integrate(square_edit(2, 6))));
    // Undone and redone, nothing but the records of that becomes more.
    for (int i = 0; i < 300; ++i) {
        s.undo({});
        s.redo({});
        ASSERT_LE(s.view().memory_bytes, s.mesh_bytes() + limits.bytes);
    }
    const HistoryCopy history = s.history(0, 1);
    EXPECT_GT(history.oldest, 300U);
    EXPECT_LT(history.oldest + 5, history.version) << "some are kept";
    EXPECT_TRUE(std::holds_alternative<VersionGone>(s.delta_since(history.oldest - 1)));
    EXPECT_TRUE(std::holds_alternative<api::MeshDelta>(s.delta_since(history.oldest)));
    EXPECT_TRUE(std::holds_alternative<core::Tin>(s.tin_at(history.oldest, {})));
}

TEST(SessionVersions, CountsTheLargestMeshOnTheWay) {
    Session s = make_session();
    const std::size_t small = s.mesh_bytes();
    PolygonEdit edit;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            const double x = 1 + i, y = 1 + j;
            edit.shapes.push_back(
                {{{{{x, y}, {x + 0.5, y}, {x + 0.5, y + 0.5}, {x, y + 0.5}}, true}}});
        }
    edit.origins.resize(edit.shapes.size());
    ASSERT_TRUE(std::holds_alternative<PolygonResult>(s.integrate(std::move(edit))));
    s.undo({});
    ASSERT_LT(s.mesh_bytes(), 2 * small);
    EXPECT_GT(s.mesh_bytes_since(2), 10 * sizeof(core::Tin::Triangle) * 8);
    EXPECT_EQ(s.mesh_bytes_since(3), s.mesh_bytes());
}

TEST(SessionVersions, MakesAVersionAgainUnlessStopped) {
    Session s = make_session();
    s.integrate(square_edit(2, 6));
    const core::Tin was = s.copy_tin();
    s.undo({});
    s.integrate(square_edit(3, 7));
    EXPECT_TRUE(test::same_tin(std::get<core::Tin>(s.tin_at(2, {})), was));
    RunLimits stopped;
    stopped.cancelled = [] { return true; };
    const auto outcome = s.tin_at(2, stopped);
    EXPECT_EQ(std::get<core::Errors>(outcome)[0].code, core::ErrorCode::Cancelled);
}

}  // namespace
}  // namespace tinsmith::server
