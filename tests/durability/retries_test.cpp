// SPDX-License-Identifier: Apache-2.0
// A request with a key is done once, however the process ended in between, and whether or not its
// answer was one to be stored.
#include <csignal>

#include <gtest/gtest.h>

#include "tests/durability/ledger.hpp"
#include "tests/durability/model.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

const std::string kLake = TINSMITH_SOURCE_DIR "/tests/data/lake.geojson";
/// Answers above this are not stored (server/routes/restored_answers.cpp).
constexpr std::size_t kLargestStored = std::size_t{256} << 10;

class Retries : public testing::Test {
  protected:
    void start() {
        server_.emplace(std::vector<std::string>{"--data", folder_.file("data")});
        ASSERT_NE(server_->port(), 0) << server_->program().output();
    }

    Answer cut_lake(const std::string& key) {
        SteadyClient client(server_->port());
        return client.ask("POST", "/v1/sessions/hills/polygons",
                          {"Content-Type: application/json", "Accept: model/gltf-binary",
                           "Idempotency-Key: " + key},
                          content_of(kLake));
    }

    ScratchDirectory folder_;
    std::optional<ServerUnderTest> server_;
};

// Found by Crash with TINSMITH_SEED=8: a snapshot had taken the place of the entry with the key.
TEST_F(Retries, AreDoneOnceWhereTheAnswerWasTooLargeToBeStored) {
    ASSERT_NO_FATAL_FAILURE(start());
    SteadyClient client(server_->port());
    ASSERT_EQ(make_bundled(client, "hills").status, 201);
    const Answer first = cut_lake("a");
    ASSERT_EQ(first.status, 200) << first.body;
    ASSERT_GT(first.body.size(), kLargestStored);
    ASSERT_EQ(version_of_tag(first.header("etag")), 2U);

    // By its entry in the journal, then by what was stored with the snapshot of an orderly stop.
    for (const bool in_order : {false, true, true}) {
        if (in_order) {
            EXPECT_EQ(server_->stop(), "");
        } else {
            server_->program().send_signal(SIGKILL);
            server_->program().wait();
        }
        ASSERT_NO_FATAL_FAILURE(start());
        const Answer again = cut_lake("a");
        EXPECT_EQ(again.status, 200) << again.body;
        EXPECT_EQ(again.header("idempotency-replayed"), "true");
        EXPECT_EQ(version_of_tag(again.header("etag")), 2U) << "it was done twice";
    }
    EXPECT_EQ(version_of_tag(cut_lake("b").header("etag")), 3U);
}

}  // namespace
}  // namespace tinsmith::e2e
