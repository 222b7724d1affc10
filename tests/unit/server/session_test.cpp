// SPDX-License-Identifier: Apache-2.0
#include "server/session.hpp"

#include <thread>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "server/session_store.hpp"

namespace tinsmith::server {
namespace {

core::Tin square() {
    core::MeshData data;
    data.vertices = {{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, 3}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    return std::move(core::build_tin(data).value());
}

PolygonEdit edit_of(double low, double high) {
    PolygonEdit edit;
    edit.shapes.push_back({{{{{low, low}, {high, low}, {high, high}, {low, high}}, true}}});
    edit.origins.emplace_back();
    return edit;
}

TEST(Session, CountsVersionsAndPolygons) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    EXPECT_EQ(s.view().version, 1U);
    EXPECT_EQ(s.etag(1), "\"b-1\"");
    const auto first = s.integrate(edit_of(2, 4));
    ASSERT_TRUE(std::holds_alternative<PolygonResult>(first));
    EXPECT_EQ(std::get<PolygonResult>(first).version, 2U);
    EXPECT_EQ(std::get<PolygonResult>(first).polygon_ids, std::vector<std::string>{"p1"});
    const auto second = s.integrate(edit_of(5, 7));
    EXPECT_EQ(std::get<PolygonResult>(second).polygon_ids, std::vector<std::string>{"p2"});
    EXPECT_EQ(s.view().polygons, 2U);
    EXPECT_EQ(s.copy_mesh().version, 3U);
    EXPECT_GT(s.view().memory_bytes, 2 * sizeof(core::Tin::Triangle));
}

TEST(Session, KeepsEverythingWhenAnEditIsRefused) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    const auto outcome = s.integrate(edit_of(20, 30));
    ASSERT_TRUE(std::holds_alternative<core::Errors>(outcome));
    EXPECT_EQ(s.view().version, 1U);
    EXPECT_EQ(s.view().polygons, 0U);
    EXPECT_EQ(s.view().triangles, 2U);
}

TEST(Session, KeepsEverythingInADryRun) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    PolygonEdit edit = edit_of(2, 4);
    edit.dry_run = true;
    edit.want_mesh = true;
    const auto outcome = s.integrate(std::move(edit));
    const auto& result = std::get<PolygonResult>(outcome);
    EXPECT_EQ(result.version, 1U);
    EXPECT_GT(result.mesh.value().triangles.size(), 2U);
    EXPECT_EQ(s.view().triangles, 2U);
    EXPECT_EQ(s.view().polygons, 0U);
}

TEST(Session, RefusesAnotherVersionThanExpected) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    for (const bool dry : {false, true}) {
        PolygonEdit edit = edit_of(2, 4);
        edit.expected_version = 7;
        edit.dry_run = dry;
        const auto outcome = s.integrate(std::move(edit));
        ASSERT_TRUE(std::holds_alternative<VersionMismatch>(outcome));
        EXPECT_EQ(std::get<VersionMismatch>(outcome).current, 1U);
    }
    EXPECT_EQ(s.view().version, 1U);
}

TEST(Session, DoesNotGrowBeyondItsLimit) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    PolygonEdit edit = edit_of(2, 4);
    edit.most.triangles = 4;
    const auto outcome = s.integrate(std::move(edit));
    ASSERT_TRUE(std::holds_alternative<core::Errors>(outcome));
    EXPECT_EQ(std::get<core::Errors>(outcome).front().code, core::ErrorCode::TriangleBudget);
    edit = edit_of(2, 4);
    edit.most = {1000, s.view().memory_bytes + 300};
    const auto too_much = s.integrate(std::move(edit));
    ASSERT_TRUE(std::holds_alternative<core::Errors>(too_much));
    EXPECT_EQ(std::get<core::Errors>(too_much).front().code, core::ErrorCode::MemoryBudget);
    EXPECT_EQ(s.view().triangles, 2U);
}

TEST(Session, ServesReadersBesideWriters) {
    Session s({"s", "b", "Square", "EPSG:32616", "metre"}, square());
    std::thread writer([&s] {
        for (int i = 0; i < 40; ++i)
            s.integrate(edit_of(1 + i * 0.1, 5 + i * 0.1));
    });
    std::uint64_t last = 0;
    while (last < 20) {
        const MeshCopy copy = s.copy_mesh();
        EXPECT_GE(copy.version, last);
        last = copy.version;
        if (s.view().version >= 41) break;
    }
    writer.join();
    EXPECT_EQ(s.view().version, 41U);
}

TEST(SessionStore, KeepsFindsAndRemoves) {
    SessionStore store{Limits{}};
    const auto added = store.add(square(), {}, {});
    ASSERT_TRUE(std::holds_alternative<std::shared_ptr<Session>>(added));
    const auto kept = std::get<0>(added);
    EXPECT_EQ(store.find(kept->facts().id, {}), kept);
    EXPECT_EQ(store.find("other", {}), nullptr);
    EXPECT_EQ(store.page({}, 10, {}).views.size(), 1U);
    EXPECT_TRUE(store.is_kept(*kept));
    EXPECT_EQ(store.remove(*kept, 2), Removal::OtherVersion);
    EXPECT_EQ(store.remove(*kept, 1), Removal::Done);
    EXPECT_EQ(store.remove(*kept), Removal::Gone);
    EXPECT_FALSE(store.is_kept(*kept));
    EXPECT_EQ(store.size(), 0U);
    EXPECT_EQ(kept->view().triangles, 2U) << "who holds it may still read";
}

TEST(SessionStore, RefusesBeyondItsLimits) {
    Limits limits;
    limits.max_sessions = 1;
    SessionStore few(limits);
    ASSERT_EQ(few.add(square(), {}, {}, "a").index(), 0U);
    EXPECT_EQ(std::get<StoreRefusal>(few.add(square(), {}, {}, "a")), StoreRefusal::IdIsTaken);
    EXPECT_EQ(std::get<StoreRefusal>(few.add(square(), {}, {})), StoreRefusal::TooMany);
    limits.max_memory_bytes = 10;
    SessionStore small(limits);
    EXPECT_EQ(std::get<StoreRefusal>(small.add(square(), {}, {})), StoreRefusal::NoMemory);
    EXPECT_EQ(small.size(), 0U);
}

TEST(SessionStore, CountsItsMemory) {
    SessionStore store{Limits{}};
    EXPECT_EQ(store.memory_bytes(), 0U);
    const auto kept = std::get<0>(store.add(square(), {}, {}));
    EXPECT_EQ(store.memory_bytes(), kept->view().memory_bytes);
    PolygonEdit edit = edit_of(2, 4);
    edit.origins[0].properties = std::string(10'000, ' ');
    kept->integrate(std::move(edit));
    EXPECT_GT(store.memory_bytes(), 10'000U);
}

TEST(SessionStore, GivesEachLifeOfAnIdAnotherBirth) {
    SessionStore store{Limits{}};
    const auto first = std::get<0>(store.add(square(), {}, {}, "a"));
    store.remove(*first);
    const auto second = std::get<0>(store.add(square(), {}, {}, "a"));
    EXPECT_NE(first->etag(1), second->etag(1));
}

}  // namespace
}  // namespace tinsmith::server
