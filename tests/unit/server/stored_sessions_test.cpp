// SPDX-License-Identifier: Apache-2.0
// Sessions with a vault, as a client meets them: over restarts, in too little memory, on disks that
// are full or damaged.
#include <chrono>
#include <filesystem>
#include <map>
#include <thread>

#include "core/types/algorithm.hpp"
#include "server/archive/session_archive.hpp"
#include "server/unix_time.hpp"
#include "tests/store/failing_disk.hpp"
#include "tests/unit/server/stored_life.hpp"

namespace tinsmith::server {
namespace {

using std::chrono::steady_clock;

TEST_F(StoredSessions, AreTheSameInTheNextLife) {
    life().make("a");
    EXPECT_EQ(life().cut("a", 2).status, 200);
    EXPECT_EQ(life().cut("a", 5).status, 200);
    life().ask("POST", "/v1/sessions/a/edits", {},
               R"({"operation": "set", "polygon": "p2", "elevation": 7})");
    life().ask("PUT", "/v1/sessions/a/locks", {},
               R"({"type": "LineString", "coordinates": [[2,2],[3,2]]})");
    life().ask("POST", "/v1/sessions/a/undo");
    life().ask("DELETE", "/v1/sessions/a/polygons/p1");
    life().ask("POST", "/v1/sessions/a/fork");
    std::map<std::string, std::string> before;
    const std::vector<std::string> paths{"a",          "a/mesh.json",         "a/history",
                                         "a/polygons", "a/mesh?version=4",    "a/locks",
                                         "a/regions",  "a/mesh.glb?version=2"};
    for (const std::string& path : paths)
        before[path] = life().get(path);
    const json list = life().list();
    const std::string tag = Life::header_of(life().ask("GET", "/v1/sessions/a"), "ETag");
    for (const bool is_in_order : {false, true}) {
        if (is_in_order) life().keeper().snapshot_all(steady_clock::time_point::max());
        restart();
        for (const std::string& path : paths) {
            if (path == "a") continue;  // what it holds in memory may differ
            EXPECT_EQ(life().get(path) == before[path], true) << path;
        }
        EXPECT_EQ(Life::header_of(life().ask("GET", "/v1/sessions/a"), "ETag"), tag);
        EXPECT_EQ(life().list(), list);
    }
    // And it goes on: ids and versions where they were.
    const json report = json::parse(life().cut("a", 8).body);
    EXPECT_EQ(report["version"], 8);
    EXPECT_EQ(report["polygons"][0]["id"], "p3");
    EXPECT_EQ(life().ask("POST", "/v1/sessions/a/undo").status, 200);
    EXPECT_EQ(life().ask("POST", "/v1/sessions/a/undo").status, 200) << "what the first life did";
}

TEST_F(StoredSessions, ThatAreDeletedStayDeleted) {
    life().make("a");
    life().make("b");
    EXPECT_EQ(life().ask("DELETE", "/v1/sessions/a").status, 200);
    restart();
    EXPECT_EQ(life().ask("GET", "/v1/sessions/a").status, 404);
    EXPECT_EQ(life().view("b")["version"], 1);
    EXPECT_EQ(life().make("a").status, 201) << "its id is free";
}

TEST_F(StoredSessions, AnswerRetriesOfTheLifeBefore) {
    life().make("a");
    const std::vector<NameValue> key{{"idempotency-key", "k-1"}}, other{{"idempotency-key", "k-2"}};
    const Response first = life().cut("a", 2, key);
    const Response forked = life().ask("POST", "/v1/sessions/a/fork", other);
    restart();
    const Response again = life().cut("a", 2, key);
    EXPECT_EQ(again.status, 200);
    EXPECT_EQ(Life::header_of(again, "Idempotency-Replayed"), "true");
    EXPECT_EQ(json::parse(again.body)["version"], json::parse(first.body)["version"]);
    EXPECT_EQ(life().cut("a", 3, key).status, 422) << "another request with the key";
    EXPECT_EQ(life().view("a")["version"], 2);
    const Response fork_again = life().ask("POST", "/v1/sessions/a/fork", other);
    EXPECT_EQ(Life::header_of(fork_again, "Location"), Life::header_of(forked, "Location"));
    EXPECT_EQ(life().services().sessions.size(), 2U);
}

TEST_F(StoredSessions, GiveTheFirstAnswerAgainAfterASnapshot) {
    life().make("a");
    std::vector<NameValue> as_glb{{"idempotency-key", "k-1"}, {"accept", "model/gltf-binary"}};
    const Response first = life().cut("a", 2, as_glb);
    EXPECT_EQ(first.content_type, "model/gltf-binary");
    life().keeper().snapshot_all(steady_clock::time_point::max());
    restart();
    const Response again = life().cut("a", 2, as_glb);
    EXPECT_EQ(Life::header_of(again, "Idempotency-Replayed"), "true");
    EXPECT_EQ(again.content_type, "model/gltf-binary");
    EXPECT_EQ(again.body == first.body, true);
    EXPECT_EQ(life().view("a")["version"], 2);
}

TEST_F(StoredSessions, LeaveMemoryForOthersAndComeBack) {
    life().make("probe");
    life().cut("probe", 3);
    life().cut("probe", 6);
    const auto each = life().view("probe")["memory_bytes"].get<std::size_t>();
    limits_.max_memory_bytes = 6 * each;
    restart();
    for (int i = 0; i < 12; ++i)
        ASSERT_EQ(life().make("s" + std::to_string(i)).status, 201) << i;
    EXPECT_LE(life().services().sessions.memory_bytes(), limits_.max_memory_bytes);
    for (int round = 1; round <= 2; ++round) {
        for (int i = 0; i < 12; ++i) {
            const std::string id = "s" + std::to_string(i);
            ASSERT_EQ(life().cut(id, round * 3).status, 200) << id;
            EXPECT_LE(life().services().sessions.memory_bytes(), limits_.max_memory_bytes + each)
                << "an edit may grow what is in memory";
        }
    }
    EXPECT_LT(life().services().sessions.totals().in_memory, 8U);
    for (int i = 0; i < 12; ++i)
        EXPECT_EQ(life().view("s" + std::to_string(i))["version"], 3);
    const json list = json::parse(life().ask("GET", "/v1/sessions").body)["sessions"];
    EXPECT_EQ(list.size(), 13U);
    for (const json& session : list)
        EXPECT_EQ(session["version"], 3) << "loaded or not";
    // What cannot come in drives nobody out.
    EXPECT_FALSE(life().services().sessions.has_room(2 * limits_.max_memory_bytes));
    EXPECT_FALSE(life().services().sessions.has_room(limits_.max_memory_bytes + 1));
    const std::size_t in_memory = life().services().sessions.totals().in_memory;
    const auto some = life().services().sessions.find("s1", {});
    EXPECT_FALSE(life().services().sessions.has_room(limits_.max_memory_bytes));
    EXPECT_GE(life().services().sessions.totals().in_memory, in_memory);
    // What is stored in order is stored of all, in memory or not.
    life().keeper().snapshot_all(steady_clock::time_point::max());
    EXPECT_EQ(life().services().sessions.ids_with_tail().size(), 0U);
    // What somebody holds stays.
    const auto held = life().services().sessions.find("s0", {});
    for (int i = 1; i < 12; ++i)
        life().get("s" + std::to_string(i));
    EXPECT_TRUE(life().services().sessions.is_kept(*held));
}

TEST_F(StoredSessions, EndWhereNobodyAsksForThem) {
    limits_.session_ttl = 3600;
    restart();
    life().make("a");
    const std::string expires = life().view("a")["expires"];
    EXPECT_EQ(expires.size(), 20U);
    EXPECT_EQ(expires.back(), 'Z');
    using std::chrono::system_clock;
    const auto now = system_clock::to_time_t(system_clock::now());
    EXPECT_TRUE(life().services().sessions.remove_unused_since(now - 3600).empty());
    // What came of questions is not stored: a start counts as one.
    life().services().vault->journal().touch(
        life().services().sessions.find("a", {})->facts().birth, 1000);
    restart();
    EXPECT_TRUE(life().services().sessions.remove_unused_since(now - 3600).empty());
    EXPECT_GT(life().view("a")["expires"], "2026");
    EXPECT_EQ(life().services().sessions.remove_unused_since(now + 10).size(), 1U);
    EXPECT_EQ(life().ask("GET", "/v1/sessions/a").status, 404);
    restart();
    EXPECT_EQ(life().ask("GET", "/v1/sessions/a").status, 404);
}

TEST_F(StoredSessions, AreStoredAnewWhenTheirTailIsLong) {
    restart({10, std::size_t{1} << 30, 1e9});
    life().make("a");
    for (int i = 0; i < 25; ++i)
        life().ask("POST", "/v1/sessions/a/" + std::string(i % 2 == 0 ? "undo" : "redo"));
    for (int i = 0; i < 12; ++i)
        ASSERT_EQ(life().cut("a", 1 + i % 4 * 2).status, 200);
    const std::string birth = life().services().sessions.find("a", {})->facts().birth;
    const auto until = steady_clock::now() + std::chrono::seconds(20);
    std::uint64_t stored = 1;
    while (stored == 1 && steady_clock::now() < until) {
        stored = std::get<0>(life().services().vault->journal().read(birth)).head.version;
        std::this_thread::yield();
    }
    EXPECT_GE(stored, 11U);
    const std::string mesh = life().get("a/mesh.json");
    restart();
    EXPECT_EQ(life().get("a/mesh.json") == mesh, true);
    EXPECT_EQ(life().tail(birth), 13 - stored);
    for (int i = 0; i < 12; ++i)
        ASSERT_EQ(life().cut("a", 2 + i % 4 * 2).status, 200);
    ASSERT_GE(life().tail(birth), 10U);
    restart({10, std::size_t{1} << 30, 1e9});
    while (life().tail(birth) > 0 && steady_clock::now() < until)
        std::this_thread::yield();
    EXPECT_EQ(life().tail(birth), 0U) << "one that comes with a long tail";
}

TEST_F(StoredSessions, ThatAreDamagedAreOutOfServiceAlone) {
    life().make("a");
    life().make("b");
    const std::string birth = life().services().sessions.find("a", {})->facts().birth;
    // A change that nobody made: its digest is not what doing it gives.
    const auto fault = life().services().vault->journal().append({birth,
                                                                  2,
                                                                  core::kAlgorithm,
                                                                  pack(ChangeAsked(UndoAsked{})),
                                                                  std::string(32, 'x'),
                                                                  {},
                                                                  {},
                                                                  pack(SessionCounts{})});
    ASSERT_FALSE(fault);
    restart();
    const Response refused = life().ask("GET", "/v1/sessions/a");
    EXPECT_EQ(refused.status, 503);
    EXPECT_NE(refused.body.find("session-out-of-service"), std::string::npos);
    EXPECT_EQ(life().cut("a", 2).status, 503);
    EXPECT_EQ(life().cut("b", 2).status, 200);
    const json list = json::parse(life().ask("GET", "/v1/sessions").body)["sessions"];
    EXPECT_EQ(list[0]["id"], "a");
    EXPECT_NE(list[0]["notes"].dump().find("Out of service"), std::string::npos);
    EXPECT_EQ(life().make("a").status, 409) << "until it is deleted";
    EXPECT_EQ(life().ask("DELETE", "/v1/sessions/a").status, 200);
    EXPECT_EQ(life().make("a").status, 201);
}

TEST_F(StoredSessions, BelongToTheirKeysInTheNextLifeToo) {
    const Asker alice{"a1", "alice", {}}, bob{"b2", "bob", {}};
    const auto as = [this](const Asker& asker) -> Life& {
        life().asker = asker;
        return life();
    };
    as({}).make("old");
    const std::vector<NameValue> key{{"idempotency-key", "k"}};
    as(alice).make("hers");
    EXPECT_EQ(as(alice).cut("hers", 2, key).status, 200);
    const Response made = as(alice).ask("POST", "/v1/sessions", key, kSquare);
    const std::string fork =
        Life::header_of(as(bob).ask("POST", "/v1/sessions/old/fork"), "Location");
    const auto check = [&] {
        const auto listed = [&](const Asker& asker) {
            return json::parse(as(asker).ask("GET", "/v1/sessions").body)["sessions"].size();
        };
        EXPECT_EQ(listed(alice), 3U);
        EXPECT_EQ(listed(bob), 2U);
        EXPECT_EQ(listed({}), 4U) << "where no keys are used, all is everyone's";
        EXPECT_EQ(as(bob).ask("GET", "/v1/sessions/hers").status, 404);
        EXPECT_EQ(as(bob).ask("DELETE", "/v1/sessions/hers").status, 404);
        EXPECT_EQ(as(bob).cut("hers", 2, key).status, 404);
        EXPECT_EQ(as(bob).make("hers").status, 409);
        EXPECT_EQ(as(alice).ask("GET", fork).status, 404);
        EXPECT_EQ(as(bob).ask("GET", fork).status, 200);
        EXPECT_EQ(Life::header_of(as(alice).cut("hers", 2, key), "Idempotency-Replayed"), "true");
        const Response again = as(alice).ask("POST", "/v1/sessions", key, kSquare);
        EXPECT_EQ(Life::header_of(again, "Idempotency-Replayed"), "true");
        EXPECT_EQ(Life::header_of(again, "Location"), Life::header_of(made, "Location"));
        EXPECT_EQ(as(bob).ask("GET", "/v1/sessions/old").status, 200);
    };
    check();
    restart();
    check();
    life().keeper().snapshot_all(steady_clock::time_point::max());
    restart();
    check();
    const Response another = as(bob).ask("POST", "/v1/sessions", key, kSquare);
    EXPECT_EQ(Life::header_of(another, "Idempotency-Replayed"), "") << "his key is not hers";
    EXPECT_NE(Life::header_of(another, "Location"), Life::header_of(made, "Location"));
}

TEST_F(StoredSessions, OfAnotherAlgorithmAreReadOnly) {
    life().make("a");
    life().cut("a", 2);
    const std::string mesh = life().get("a/mesh.json");
    life().keeper().snapshot_all(steady_clock::time_point::max());
    const std::string birth = life().services().sessions.find("a", {})->facts().birth;
    ASSERT_FALSE(life().services().vault->journal().append({birth,
                                                            3,
                                                            core::kAlgorithm + 1,
                                                            "whatever it does",
                                                            std::string(32, 'x'),
                                                            {},
                                                            {},
                                                            pack(SessionCounts{})}));
    restart();
    EXPECT_EQ(life().get("a/mesh.json") == mesh, true);
    EXPECT_NE(life().view("a")["notes"].dump().find("read-only"), std::string::npos);
    const Response refused = life().cut("a", 5);
    EXPECT_EQ(refused.status, 409);
    EXPECT_NE(refused.body.find("session-read-only"), std::string::npos);
    EXPECT_EQ(life().get("a/mesh.json") == mesh, true) << "nothing of it stays";
}

TEST_F(StoredSessions, RefuseEditsWhileTheDiskIsFullAndGoOnAfter) {
    store_tests::FailingDisk disk("stored-sessions-disk");
    options_.vfs = disk.name();
    options_.probe_every = std::chrono::milliseconds(5);
    life().make("a");
    life().cut("a", 2);
    const std::string mesh = life().get("a/mesh.json"), history = life().get("a/history");
    for (const auto work :
         {store_tests::FailingDisk::Work::Write, store_tests::FailingDisk::Work::Sync}) {
        disk.fail(work, store_tests::FailingDisk::Fault::Full, 0, UINT64_MAX);
        for (const Response& refused :
             {life().cut("a", 5), life().ask("POST", "/v1/sessions/a/undo"),
              life().ask("DELETE", "/v1/sessions/a/polygons/p1"), life().make("b"),
              life().ask("DELETE", "/v1/sessions/a")}) {
            EXPECT_EQ(refused.status, 503) << refused.body;
            EXPECT_NE(refused.body.find("storage-unavailable"), std::string::npos);
        }
        EXPECT_FALSE(life().services().vault->journal().health().fine);
        EXPECT_EQ(life().get("a/mesh.json") == mesh, true);
        EXPECT_EQ(life().get("a/history"), history);
        EXPECT_EQ(life().ask("GET", "/v1/sessions/b").status, 404);
        disk.mend();
        const auto until = steady_clock::now() + std::chrono::seconds(20);
        while (!life().services().vault->journal().health().fine && steady_clock::now() < until)
            std::this_thread::yield();
        EXPECT_TRUE(life().services().vault->journal().health().fine);
    }
    EXPECT_EQ(life().cut("a", 5).status, 200);
    EXPECT_EQ(life().make("b").status, 201);
    // Time passes, but nothing can be written of it.
    disk.fail(store_tests::FailingDisk::Work::Write, store_tests::FailingDisk::Fault::Full, 0,
              UINT64_MAX);
    EXPECT_TRUE(life().services().sessions.remove_unused_since(unix_seconds() + 10).empty());
    disk.mend();
    const std::string after = life().get("a/mesh.json");
    restart();
    EXPECT_EQ(life().get("a/mesh.json") == after, true);
    end();  // before the disk
}

}  // namespace
}  // namespace tinsmith::server
