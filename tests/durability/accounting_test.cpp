// SPDX-License-Identifier: Apache-2.0
// What sessions are said to take is what the process takes for them.
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

constexpr double kMiB = 1 << 20;
const std::string kTerrain = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/jacksboro.tif";

/// A sanitizer's own memory would count, too.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kHasSanitizer = true;
#else
constexpr bool kHasSanitizer = false;
#endif

class Accounting : public testing::Test {
  protected:
    void SetUp() override {
        if (kHasSanitizer) GTEST_SKIP() << "memory of a sanitizer's own is in the way";
        server_.emplace(std::vector<std::string>{"--mesh-cache", "0"});
        ASSERT_NE(server_->port(), 0) << server_->program().output();
        client_.emplace(server_->port());
        // What the process needs once, however many sessions there are.
        ASSERT_EQ(put("first").status, 201);
        ASSERT_EQ(cut("first", dice_).status, 200);
    }

    Answer put(const std::string& id) {
        return client_->ask("PUT", "/v1/sessions/" + id, {"Content-Type: image/tiff"},
                            content_of(kTerrain));
    }

    /// A parcel somewhere on the terrain.
    Answer cut(const std::string& id, Dice& dice) {
        if (bounds_.empty())
            bounds_ = json::parse(client_->ask("GET", "/v1/sessions/" + id).body)["bounds"]
                          .get<std::vector<double>>();
        const auto somewhere = [&](std::size_t axis) {
            const double low = bounds_[axis], high = bounds_[axis + 3];
            return dice.between(low + 0.1 * (high - low), high - 0.1 * (high - low));
        };
        const std::string ring = ring_text(dice, somewhere(0), somewhere(1), 300, 30);
        return client_->ask("POST", "/v1/sessions/" + id + "/polygons",
                            {"Content-Type: application/json"}, polygon_text(ring));
    }

    /// MiB that all sessions are said to take.
    double told() {
        double sum = 0;
        const json list = json::parse(client_->ask("GET", "/v1/sessions").body)["sessions"];
        for (const json& session : list)
            sum += session["memory_bytes"].get<double>();
        return sum / kMiB;
    }

    /// MiB that the process has.
    double resident() {
        std::ifstream status("/proc/" + std::to_string(server_->program().pid()) + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) * 1024 / kMiB;
        return 0;
    }

    /// How much more the process has for each MiB more that it tells of.
    double ratio_over(const std::function<void()>& work) {
        const double told_before = told(), resident_before = resident();
        work();
        const double more = told() - told_before;
        const double ratio = (resident() - resident_before) / more;
        RecordProperty("told_mib", std::to_string(more));
        RecordProperty("ratio", std::to_string(ratio));
        std::cout << "told " << more << " MiB, the process has " << ratio << " times that\n";
        return ratio;
    }

    std::optional<ServerUnderTest> server_;
    std::optional<SteadyClient> client_;
    std::vector<double> bounds_;
    Dice dice_{11};
};

TEST_F(Accounting, OfMeshesIsTrue) {
    const double ratio = ratio_over([&] {
        for (int i = 0; i < 8; ++i)
            ASSERT_EQ(put("s" + std::to_string(i)).status, 201);
    });
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, 1.2);
}

TEST_F(Accounting, OfHistoriesIsTrue) {
    const double ratio = ratio_over([&] {
        for (int i = 0; i < 600; ++i)
            ASSERT_EQ(cut("first", dice_).status, 200);
    });
    EXPECT_GT(ratio, 0.7);
    EXPECT_LT(ratio, 1.5);
}

TEST_F(Accounting, OfWhatIsDeletedIsTrue) {
    for (int i = 0; i < 8; ++i)
        ASSERT_EQ(put("s" + std::to_string(i)).status, 201);
    const double ratio = ratio_over([&] {
        for (int i = 0; i < 8; ++i)
            ASSERT_EQ(client_->ask("DELETE", "/v1/sessions/s" + std::to_string(i)).status, 200);
    });
    EXPECT_GT(ratio, 0.8) << "memory is kept that nobody counts";
}

}  // namespace
}  // namespace tinsmith::e2e
