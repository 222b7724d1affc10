// SPDX-License-Identifier: Apache-2.0
// The guarantees on random meshes and shapes of every kind, the whole mesh verified after each
// operation. See seeds.hpp for how to choose seeds and their number, shrink_case for how to make a
// case file of one that fails.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/property/seeds.hpp"
#include "tests/support/random_case.hpp"
#include "tests/verify/exact.hpp"

namespace tinsmith {
namespace {

class IntegrateProperty : public testing::TestWithParam<std::uint64_t> {};

TEST_P(IntegrateProperty, GuaranteesHoldOnRandomMeshesAndShapes) {
    test::SeedRun run(GetParam(), 100'000);
    std::uint64_t refused = 0;
    std::array<std::uint64_t, test::kMeshKinds> of_kind{};
    while (run.more()) {
        const std::uint64_t seed = run.next();
        test::RandomCase random(seed);
        if (!random.more()) continue;
        const std::string kind = test::name_of(random.kind());
        test::Trial trial(random.mesh());
        std::vector<std::string> broken = trial.broken();
        if (!broken.empty()) run.fault("MESH", seed, kind + ": " + broken[0]);
        while (broken.empty() && random.more()) {
            const test::Verdict verdict = trial.apply(random.next(trial.mesh()));
            run.count();
            ++of_kind[static_cast<std::size_t>(random.kind())];
            refused += verdict.refused;
            broken = verdict.broken;
            if (broken.empty()) continue;
            // Refusals for want of doubles are counted by kind of mesh.
            std::string word = verdict.kind();
            if (word == "NOT_REPRESENTABLE") word += " on " + kind;
            run.fault(word, seed, kind + ": " + broken[0]);
        }
    }
    for (int k = 0; k < test::kMeshKinds; ++k) {
        const auto kind = static_cast<test::MeshKind>(k);
        run.allow(std::string("NOT_REPRESENTABLE on ") + test::name_of(kind),
                  test::unrepresentable_per_million(kind), of_kind[static_cast<std::size_t>(k)]);
    }
    run.judge();
    std::cout << refused << " refused, " << verify::rational_decisions() << " rational decisions\n";
}

INSTANTIATE_TEST_SUITE_P(Shards, IntegrateProperty,
                         testing::Range(std::uint64_t{0}, test::kShards));

}  // namespace
}  // namespace tinsmith
