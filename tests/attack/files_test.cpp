// SPDX-License-Identifier: Apache-2.0
// Files that lie about their sizes, and small ones that would grow by far: refused in time, with no
// memory to speak of.
#include <chrono>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/attack/lying_files.hpp"
#include "tests/attack/victim.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

/// For one file, on a machine that does more.
constexpr int kMostSeconds = 10;

/// What a body of a few megabytes may take beside the limit: it is in memory while it is read.
double room_for(const std::string& body) {
    return kMostMebiForRefused + 3 * static_cast<double>(body.size()) / (1 << 20);
}

class LyingFiles : public testing::Test {
  protected:
    static void expect_refused(const std::vector<LyingFile>& files) {
        Victim victim;
        for (const LyingFile& file : files) {
            SCOPED_TRACE(file.name);
            victim.watch_memory();
            const auto start = Clock::now();
            Connection connection(victim.port(), 2 * kMostSeconds);
            connection.send(
                request_text("POST", "/v1/sessions", {"Content-Type: " + file.type}, file.bytes));
            const Answer answer = connection.read();
            const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
            EXPECT_EQ(answer.status, file.status) << answer.body;
            EXPECT_EQ(answer.header("content-type"), "application/problem+json");
            EXPECT_NE(answer.body.find(file.code), std::string::npos) << answer.body;
            EXPECT_LT(seconds, kMostSeconds);
            if (is_long_form())
                std::cout << file.name << ": " << answer.status << ", " << victim.growth()
                          << " MiB, " << seconds << " s\n";
            const std::string harm = victim.harm(room_for(file.bytes));
            ASSERT_EQ(harm, "");
        }
        EXPECT_EQ(victim.harm_at_the_end(2 * kMostMebiForRefused), "");
    }
};

TEST_F(LyingFiles, OfGltf) {
    expect_refused(lying_gltf());
}

TEST_F(LyingFiles, OfGltfInVeryManyParts) {
    expect_refused(crowded_gltf());
}

TEST_F(LyingFiles, OfAMeshInVeryManyPlaces) {
    expect_refused({mesh_in_many_places()});
}

TEST_F(LyingFiles, OfGeoTiff) {
    expect_refused(lying_tiffs());
}

TEST_F(LyingFiles, OfText) {
    expect_refused(lying_texts());
}

}  // namespace
}  // namespace tinsmith::e2e
