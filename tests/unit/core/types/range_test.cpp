// SPDX-License-Identifier: Apache-2.0
#include "core/types/range.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tinsmith::core {
namespace {

TEST(CoordinateRange, TakesZeroAndWhatLiesBetweenFloorAndLimit) {
    for (const double x : {0.0, -0.0, 1e-60, -1e-60, 1e15, -1e15, 1.0, 5e6})
        EXPECT_TRUE(in_coordinate_range(x)) << x;
}

TEST(CoordinateRange, RefusesWhatLiesBeyond) {
    for (const double x : {std::nextafter(1e15, HUGE_VAL), -1e16, std::nextafter(1e-60, 0.0),
                           -1e-61, 5e-324, HUGE_VAL, -HUGE_VAL})
        EXPECT_FALSE(in_coordinate_range(x)) << x;
    EXPECT_FALSE(in_coordinate_range(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace tinsmith::core
