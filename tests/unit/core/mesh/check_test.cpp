// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/check.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

bool names(const std::vector<Violation>& violations, const std::string& law) {
    for (const Violation& violation : violations)
        if (violation.law == law) return true;
    return false;
}

TEST(CheckTin, FindsNothingInAValidMesh) {
    for (const auto diagonals :
         {test::Diagonals::Rising, test::Diagonals::Falling, test::Diagonals::Alternate}) {
        EXPECT_TRUE(check_tin(test::built(test::grid(5, 4, diagonals))).empty());
        EXPECT_TRUE(check_tin(test::built(test::ring_of_cells(diagonals))).empty());
    }
    EXPECT_TRUE(check_tin(test::built(test::one_triangle())).empty());
}

// Surgery leaves the first law to its caller: that is how a mesh can be broken from outside.
TEST(CheckTin, FindsATriangleTurnedOver) {
    Tin tin = test::built(test::grid(2, 2));
    Surgery surgery(tin);
    surgery.split_triangle({0}, {-1, 5, 0});
    surgery.commit();
    EXPECT_TRUE(names(check_tin(tin), "orientation"));
    EXPECT_FALSE(names(check_tin(tin), "adjacency"));
}

TEST(CheckTin, FindsAFlatTriangle) {
    Tin tin = test::built(test::grid(2, 2));
    Surgery surgery(tin);
    surgery.split_triangle({0}, {0.5, 0, 0});
    surgery.commit();
    EXPECT_TRUE(names(check_tin(tin), "orientation"));
}

TEST(CheckTin, FindsACoordinateThatIsNotFiniteOrOutOfRange) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e16, 1e-70}) {
        Tin tin = test::built(test::grid(2, 2));
        Surgery surgery(tin);
        surgery.split_triangle({0}, {0.5, 0.25, bad});
        surgery.commit();
        EXPECT_TRUE(names(check_tin(tin), "coordinate")) << bad;
    }
}

TEST(CheckTin, FindsMarksLeftByAnOperationThatRuns) {
    Tin tin = test::built(test::grid(2, 2));
    Surgery surgery(tin);
    surgery.mark_constrained({{0}, 0});
    EXPECT_TRUE(names(check_tin(tin), "marks"));
    surgery.roll_back();
    EXPECT_TRUE(check_tin(tin).empty());
}

TEST(CheckTin, NamesNoMoreThanItsLimit) {
    Tin tin = test::built(test::grid(2, 2));
    Surgery surgery(tin);
    for (int i = 0; i < 10; ++i)
        surgery.split_triangle({0}, {-1.0 - i, 5, 0});
    surgery.commit();
    EXPECT_EQ(check_tin(tin, 3).size(), 3u);
    EXPECT_GT(check_tin(tin).size(), 3u);
}

}  // namespace
}  // namespace tinsmith::core
