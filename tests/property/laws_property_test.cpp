// SPDX-License-Identifier: Apache-2.0
// What holds between two integrations, on random meshes and shapes: see support/laws.hpp.
#include <string>

#include <gtest/gtest.h>

#include "tests/property/seeds.hpp"
#include "tests/support/laws.hpp"
#include "tests/support/random_case.hpp"

namespace tinsmith {
namespace {

class LawsProperty : public testing::TestWithParam<std::uint64_t> {};

TEST_P(LawsProperty, HoldBetweenTwoIntegrations) {
    test::SeedRun run(GetParam(), 10'000);
    while (run.more()) {
        const std::uint64_t seed = run.next();
        test::RandomCase random(seed);
        if (!random.more()) continue;
        const test::Trial trial(random.mesh());
        const test::Request request = random.next(trial.mesh());
        run.count();
        for (const std::string& fault : test::check_laws(trial.tin(), request))
            run.fault(fault.substr(0, fault.find(':')), seed,
                      std::string(test::name_of(random.kind())) + ": " + fault);
    }
    // Known and not mended; these numbers only ever shrink.
    run.allow("TWICE", 2000, run.operations());          // twice_adds_a_vertex
    run.allow("TWICE_SNAPPED", 7000, run.operations());  // the same with a snap distance
    run.allow("REVERSED", 6000, run.operations());       // reversed_ring_other_vertices
    run.judge();
}

INSTANTIATE_TEST_SUITE_P(Shards, LawsProperty, testing::Range(std::uint64_t{0}, test::kShards));

}  // namespace
}  // namespace tinsmith
