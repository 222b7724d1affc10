// SPDX-License-Identifier: Apache-2.0
// The guarantees on random meshes and shapes of every kind, the whole mesh verified after each
// operation. A failure names its seed; TINSMITH_SEED=n runs that one alone, TINSMITH_OPERATIONS=n
// sets how many are tried in all, TINSMITH_FIRST_SEED=n where the seeds begin.
#include <cstdlib>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/random_case.hpp"
#include "tests/verify/exact.hpp"

namespace tinsmith {
namespace {

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// The operations are shared out among shards that run beside each other.
constexpr std::uint64_t kShards = 8;

struct Tally {
    std::uint64_t operations = 0;
    std::uint64_t refused = 0;
    std::uint64_t unrepresentable = 0;
};

/// One mesh, a few operations on it. Returns what broke.
std::vector<std::string> try_seed(std::uint64_t seed, Tally& tally) {
    test::RandomCase random(seed);
    if (!random.more()) return {};
    test::Trial trial(random.mesh(), random.leniency());
    std::vector<std::string> broken = trial.broken();
    for (int round = 0; broken.empty() && random.more(); ++round) {
        const test::Verdict verdict = trial.apply(random.next(trial.mesh()));
        ++tally.operations;
        tally.refused += verdict.refused;
        tally.unrepresentable += verdict.unrepresentable;
        broken = verdict.broken;
        if (!broken.empty())
            broken.push_back("round " + std::to_string(round) + ", mesh kind " +
                             std::to_string(static_cast<int>(random.kind())));
    }
    return broken;
}

class IntegrateProperty : public testing::TestWithParam<std::uint64_t> {};

TEST_P(IntegrateProperty, GuaranteesHoldOnRandomMeshesAndShapes) {
    const std::uint64_t wanted = number_from("TINSMITH_OPERATIONS", 50000) / kShards;
    const std::uint64_t only = number_from("TINSMITH_SEED", 0);
    const std::uint64_t first = number_from("TINSMITH_FIRST_SEED", 1);
    Tally tally;
    std::uint64_t failures = 0;
    for (std::uint64_t seed = only != 0 ? only : first + GetParam();
         tally.operations < wanted && failures < 20; seed += kShards) {
        const auto broken = try_seed(seed, tally);
        if (!broken.empty()) {
            ++failures;
            std::string text;
            for (std::size_t i = 0; i < broken.size() && i < 6; ++i)
                text += "\n  " + broken[i];
            if (broken.size() > 6) text += "\n  " + broken.back();
            ADD_FAILURE() << "TINSMITH_SEED=" << seed << text;
        }
        if (only != 0) break;
    }
    EXPECT_LE(tally.unrepresentable, 1 + tally.operations / 500);
    std::cout << "seeds from " << first + GetParam() << ", every " << kShards
              << "th: " << tally.operations << " operations, " << tally.refused << " refused, "
              << tally.unrepresentable << " of those because no mesh of doubles would do, "
              << verify::rational_decisions() << " rational decisions\n";
}

INSTANTIATE_TEST_SUITE_P(Shards, IntegrateProperty, testing::Range(std::uint64_t{0}, kShards));

}  // namespace
}  // namespace tinsmith
