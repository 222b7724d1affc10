// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_cache.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

MeshCache::Found mesh_of(std::uint64_t version, std::size_t bytes) {
    return std::make_shared<const EncodedMesh>(
        EncodedMesh{version, {200, "x", {}, std::string(bytes, 'm'), false}});
}

MeshCache::Encode makes(std::uint64_t version, std::size_t bytes = 10) {
    return [=] { return mesh_of(version, bytes); };
}

MeshCache::Encode fails_the_test() {
    return []() -> MeshCache::Found {
        ADD_FAILURE() << "encoded again";
        return nullptr;
    };
}

TEST(MeshCache, EncodesOnce) {
    MeshCache cache(10'000);
    const auto first = cache.get({"a", 1, "-glb"}, makes(1));
    EXPECT_EQ(cache.get({"a", 1, "-glb"}, fails_the_test()), first);
    cache.get({"a", 1, "-json"}, makes(1));
    cache.get({"a", 2, "-glb"}, makes(2));
    cache.get({"b", 1, "-glb"}, makes(1));
    EXPECT_EQ(cache.counts().encodings, 4U);
    EXPECT_EQ(cache.counts().hits, 1U);
    EXPECT_EQ(cache.counts().entries, 4U);
}

TEST(MeshCache, FilesAMeshUnderTheVersionItHas) {
    MeshCache cache(10'000);
    EXPECT_EQ(cache.get({"a", 1, "-glb"}, makes(2))->version, 2U);
    EXPECT_EQ(cache.get({"a", 2, "-glb"}, fails_the_test())->version, 2U);
    EXPECT_EQ(cache.get({"a", 1, "-glb"}, makes(1))->version, 1U);
}

TEST(MeshCache, DropsWhatWasAskedForLongestAgo) {
    MeshCache cache(8'000);
    cache.get({"a", 1, "x"}, makes(1, 3000));
    cache.get({"a", 2, "x"}, makes(2, 3000));
    cache.get({"a", 1, "x"}, fails_the_test());
    cache.get({"a", 3, "x"}, makes(3, 3000));
    EXPECT_LE(cache.counts().bytes, 8'000U);
    cache.get({"a", 1, "x"}, fails_the_test());
    cache.get({"a", 3, "x"}, fails_the_test());
    cache.get({"a", 2, "x"}, makes(2, 3000));
    EXPECT_EQ(cache.counts().encodings, 4U);
    cache.get({"a", 4, "x"}, makes(4, 20'000));
    EXPECT_EQ(cache.counts().entries, 2U) << "one beyond the budget drives nothing out";
}

TEST(MeshCache, KeepsNothingOnNoBudget) {
    MeshCache cache(0);
    cache.get({"a", 1, "x"}, makes(1));
    cache.get({"a", 1, "x"}, makes(1));
    EXPECT_EQ(cache.counts().encodings, 2U);
    EXPECT_EQ(cache.counts().bytes, 0U);
}

TEST(MeshCache, ForgetsASession) {
    MeshCache cache(10'000);
    cache.get({"a", 1, "x"}, makes(1));
    cache.get({"b", 1, "x"}, makes(1));
    cache.get({"a", 2, "x"}, makes(2));
    cache.forget("a");
    EXPECT_EQ(cache.counts().entries, 1U);
    cache.get({"b", 1, "x"}, fails_the_test());
    cache.forget("b");
    EXPECT_EQ(cache.counts().bytes, 0U);
}

TEST(MeshCache, KeepsNoRefusalAndOutlivesAnException) {
    MeshCache cache(10'000);
    EXPECT_EQ(cache.get({"a", 1, "x"}, [] { return nullptr; }), nullptr);
    EXPECT_THROW(
        cache.get({"a", 1, "x"}, []() -> MeshCache::Found { throw std::runtime_error("no"); }),
        std::runtime_error);
    EXPECT_NE(cache.get({"a", 1, "x"}, makes(1)), nullptr);
}

TEST(MeshCache, EncodesOnceForAllWhoAskAtOnce) {
    MeshCache cache(1'000'000);
    std::atomic<int> encodings{0};
    std::vector<std::thread> askers;
    for (int i = 0; i < 8; ++i) {
        askers.emplace_back([&] {
            for (std::uint64_t version = 1; version <= 20; ++version) {
                const auto found = cache.get({"a", version, "x"}, [&] {
                    ++encodings;
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                    return mesh_of(version, 100);
                });
                EXPECT_EQ(found->version, version);
            }
        });
    }
    for (std::thread& asker : askers)
        asker.join();
    EXPECT_EQ(encodings, 20);
    EXPECT_EQ(cache.counts().hits, 140U);
}

TEST(MeshCache, LetsWaitersTryWhereTheFirstFails) {
    MeshCache cache(1'000'000);
    std::atomic<int> calls{0};
    std::atomic<int> found{0};
    std::vector<std::thread> askers;
    for (int i = 0; i < 6; ++i) {
        askers.emplace_back([&] {
            const auto mesh = cache.get({"a", 1, "x"}, [&]() -> MeshCache::Found {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                return ++calls < 3 ? nullptr : mesh_of(1, 1);
            });
            if (mesh) ++found;
        });
    }
    for (std::thread& asker : askers)
        asker.join();
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(found, 4);
}

}  // namespace
}  // namespace tinsmith::server
