// SPDX-License-Identifier: Apache-2.0
// The core's own look at what it promised: what is in order passes, what is not is found.
#include "core/integrate/promise.hpp"

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/integrate/reach.hpp"
#include "core/integrate/way.hpp"
#include "core/mesh/surgery.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::line;

class Promise : public testing::Test {
  protected:
    void SetUp() override {
        const Result<Report> report = integrate(tin_, shapes_, options_, &undo_);
        ASSERT_TRUE(report);
        reports_ = report->shapes;
    }

    std::optional<BrokenPromise> broken() const {
        const Replaced replaced(tin_, undo_);
        return find_broken_promise(
            {tin_, replaced, shapes_, reports_, options_, reach_of_rounding(tin_)});
    }

    Tin tin_ = built(grid(6, 6, test::Diagonals::Alternate));
    std::vector<Shape> shapes_{line({{0.3, 0.4}, {4.7, 3.1}}), line({{0.5, 3.9}, {4.2, 0.8}})};
    IntegrateOptions options_;
    Undo undo_;
    std::vector<ShapeReport> reports_;
};

TEST_F(Promise, WhatIsInOrderPasses) {
    EXPECT_FALSE(broken());
}

TEST_F(Promise, AChainThatEndsEarlyIsFound) {
    reports_[1].chains.front().vertices.pop_back();
    const auto found = broken();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->shape, 1U);
}

TEST_F(Promise, AChainOffItsSegmentIsFound) {
    shapes_[0].paths[0].points[1].y += 1e-9;
    EXPECT_TRUE(broken());
}

TEST_F(Promise, VerticesWithoutAReasonAreFound) {
    shapes_.pop_back();
    reports_.pop_back();
    EXPECT_TRUE(broken());
}

TEST_F(Promise, ASurfaceThatMovedIsFound) {
    Surgery surgery(tin_);
    surgery.set_elevation(reports_[0].chains[0].vertices[1], 7.0);
    undo_.push_back(surgery.commit());
    EXPECT_TRUE(broken());
}

TEST(Ways, EndAfterAFixedNumberOfTries) {
    Ways ways;
    std::size_t tries = 0;
    while (ways.change(0, tries % 3))
        ASSERT_LT(++tries, 1000U);
    EXPECT_GT(tries, kWays.size());
}

TEST(Ways, ChangeForThePathThatWentWrong) {
    Ways ways;
    EXPECT_TRUE(ways.change(1, 2));
    EXPECT_TRUE(ways.of(1, 2).is_reversed);
    EXPECT_FALSE(ways.of(1, 1).is_reversed);
}

}  // namespace
}  // namespace tinsmith
