// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/progress.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

/// Rings inside each other, across all of a grid.
std::vector<Shape> rings(int count, double side) {
    std::vector<Shape> shapes;
    for (int i = 0; i < count; ++i) {
        const double low = 0.3 + i * 0.21, high = side - 0.4 - i * 0.23;
        shapes.push_back(
            {{{{{low, low}, {high, low + 0.1}, {high - 0.1, high}, {low, high}}, true}}});
    }
    return shapes;
}

TEST(Progress, GrowsWithTheSegmentsOfAllShapes) {
    for (const Improve improve : {Improve::Strict, Improve::Paper}) {
        Tin watched = test::built(test::grid(40, 40));
        Tin unwatched = watched;
        std::vector<double> told;
        IntegrateOptions options;
        options.improve = improve;
        ASSERT_TRUE(integrate(unwatched, rings(20, 40), options));
        options.progress = [&told](double share) { told.push_back(share); };
        ASSERT_TRUE(integrate(watched, rings(20, 40), options));
        EXPECT_TRUE(test::same_slots(watched, unwatched)) << "being watched changes nothing";
        EXPECT_TRUE(std::ranges::is_sorted(told));
        ASSERT_GE(told.size(), 20U);
        EXPECT_GE(told.front(), 0.0);
        EXPECT_LT(told.front(), 0.1);
        EXPECT_GT(told.back(), 0.9);
        EXPECT_LE(told.back(), 1.0);
    }
}

TEST(Progress, IsTellingWithinALongSegment) {
    Tin tin = test::built(test::grid(2000, 1));
    std::vector<double> told;
    IntegrateOptions options;
    options.progress = [&told](double share) { told.push_back(share); };
    ASSERT_TRUE(
        integrate(tin, std::vector<Shape>{{{{{{0.5, 0.4}, {1999.5, 0.6}}, false}}}}, options));
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_GE(told.size(), 5U);
}

TEST(Progress, ComesToTheEndWithAnyNumberOfPoints) {
    std::vector<double> told;
    const std::function<void(double)> tell = [&told](double share) { told.push_back(share); };
    const std::vector<Shape> none{{{{{}, true}}}};
    Progress progress(tell, none, 0.5);
    EXPECT_TRUE(progress.is_asked_for());
    progress.tell(0.0);
    progress.end_segment();
    progress.tell(7.0);
    progress.begin();
    progress.tell(0.0);
    EXPECT_EQ(told, (std::vector<double>{0.0, 0.5, 0.0}));
}

}  // namespace
}  // namespace tinsmith::core
