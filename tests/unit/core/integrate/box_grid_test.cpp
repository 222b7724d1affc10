// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/box_grid.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tinsmith::core {
namespace {

/// What `near` must say: every box looked at.
std::vector<std::uint32_t> all_that_meet(const std::vector<Box>& boxes, const Box& asked) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].meets(asked)) found.push_back(i);
    return found;
}

void expect_found(const std::vector<Box>& boxes, const std::vector<Box>& questions) {
    BoxGrid grid(boxes);
    for (const Box& asked : questions)
        EXPECT_EQ(grid.near(asked), all_that_meet(boxes, asked));
    for (const Box& asked : boxes)
        EXPECT_EQ(grid.near(asked), all_that_meet(boxes, asked));
}

std::vector<Box> random_boxes(std::mt19937_64& random, std::size_t count, double extent) {
    std::uniform_real_distribution<double> place(-extent, extent);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 p{place(random), place(random)};
        boxes.push_back(Box::around(p, {p.x + place(random) / 8, p.y + place(random) / 8}));
    }
    return boxes;
}

TEST(BoxGrid, FindsWhatLookingAtEveryBoxFinds) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::mt19937_64 random(seed);
        expect_found(random_boxes(random, 1 + seed * 10, 5.0), random_boxes(random, 50, 8.0));
    }
}

TEST(BoxGrid, TakesBoxesThatReachToInfinity) {
    std::mt19937_64 random(7);
    std::vector<Box> boxes = random_boxes(random, 60, 5.0);
    const std::vector<Box> questions = random_boxes(random, 30, 8.0);
    boxes.push_back(Box::around({1, 1}, {1, 1}, HUGE_VAL));
    expect_found(boxes, questions);
    boxes.push_back({{-HUGE_VAL, 2}, {0, 3}});
    boxes.push_back({{0, 2}, {HUGE_VAL, 3}});
    expect_found(boxes, questions);
    expect_found({boxes[60]}, questions);
}

TEST(BoxGrid, TakesBoxesInOnePlaceAndDenormalWidths) {
    const Box point = Box::around({3, 4}, {3, 4});
    const Box beside = Box::around({3, 4}, {3, 4}, 5e-324);
    expect_found({point, point, beside}, {point, Box::around({0, 0}, {9, 9})});
    expect_found({Box::around({0, 0}, {5e-324, 0})}, {Box::around({0, 0}, {0, 0})});
    BoxGrid none({});
    EXPECT_TRUE(none.near(point).empty());
}

}  // namespace
}  // namespace tinsmith::core
