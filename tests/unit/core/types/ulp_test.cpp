// SPDX-License-Identifier: Apache-2.0
#include "core/types/ulp.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace tinsmith::core {
namespace {

TEST(Ulp, IsTheSpacingAboveTheMagnitude) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, 0.1, 5e6, -5e6, 1e15, 1e-60, 2.0, 4194304.0,
                           std::nextafter(2.0, 0.0), 5e-324})
        EXPECT_EQ(ulp(x), std::nextafter(std::fabs(x), HUGE_VAL) - std::fabs(x)) << x;
    EXPECT_EQ(ulp(1.0), std::numeric_limits<double>::epsilon());
    EXPECT_EQ(ulp(0.0), 5e-324);
}

TEST(Neighbour, IsTheNextDoubleEitherWay) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> values(-1e3, 1e3);
    for (int i = 0; i < 10'000; ++i) {
        const double x = values(random);
        ASSERT_EQ(neighbour(x, true), std::nextafter(x, HUGE_VAL));
        ASSERT_EQ(neighbour(x, false), std::nextafter(x, -HUGE_VAL));
    }
}

TEST(Neighbour, CrossesZeroAndPowersOfTwo) {
    for (const double x : {0.0, -0.0, 5e-324, -5e-324, 1.0, -1.0, 2.0, -1024.0}) {
        EXPECT_EQ(neighbour(x, true), std::nextafter(x, HUGE_VAL)) << x;
        EXPECT_EQ(neighbour(x, false), std::nextafter(x, -HUGE_VAL)) << x;
    }
}

}  // namespace
}  // namespace tinsmith::core
