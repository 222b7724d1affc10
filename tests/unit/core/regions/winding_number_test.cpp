// SPDX-License-Identifier: Apache-2.0
#include "core/regions/winding_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"

namespace tinsmith::core {
namespace {

std::vector<DirectedSegment> closed(const std::vector<Point2>& points) {
    std::vector<DirectedSegment> segments;
    for (std::size_t i = 0; i < points.size(); ++i)
        segments.push_back({points[i], points[(i + 1) % points.size()]});
    return segments;
}

TEST(WindingNumber, OfNoLineIsZero) {
    EXPECT_EQ(WindingNumber({}).around({0, 0}), 0);
    EXPECT_EQ(WindingNumber(closed({{0, 1}, {5, 1}})).around({2, 1.5}), 0);
}

TEST(WindingNumber, TellsDirectionAndTurns) {
    const std::vector<Point2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    std::vector<DirectedSegment> twice = closed(square);
    EXPECT_EQ(WindingNumber(twice).around({1, 1}), 1);
    EXPECT_EQ(WindingNumber(twice).around({-1, 1}), 0);
    EXPECT_EQ(WindingNumber(twice).around({5, 1}), 0);
    EXPECT_EQ(WindingNumber(twice).around({1, 7}), 0);
    EXPECT_EQ(WindingNumber(twice).around({1, -7}), 0);
    const auto again = closed(square);
    twice.insert(twice.end(), again.begin(), again.end());
    EXPECT_EQ(WindingNumber(twice).around({1, 1}), 2);
    EXPECT_EQ(WindingNumber(closed({{0, 4}, {4, 4}, {4, 0}, {0, 0}})).around({3, 3}), -1);
}

TEST(WindingNumber, IsExactBesideASegment) {
    const WindingNumber number(closed({{0, 0}, {3e6, 1e6}, {0, 1e6}}));
    const double x = 1.5e6;
    const double y = 5e5;  // on the line
    EXPECT_EQ(number.around({x, std::nextafter(y, 1e9)}), 1);
    EXPECT_EQ(number.around({x, std::nextafter(y, 0)}), 0);
}

TEST(WindingNumber, OfRaysThroughVerticesCountsThemOnce) {
    const WindingNumber diamond(closed({{0, -2}, {2, 0}, {0, 2}, {-2, 0}}));
    EXPECT_EQ(diamond.around({0, 0}), 1);
    EXPECT_EQ(diamond.around({-3, 0}), 0);
    EXPECT_EQ(diamond.around({-3, 2}), 0);
    EXPECT_EQ(diamond.around({-3, -2}), 0);
    const WindingNumber stairs(closed({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {0, 2}}));
    EXPECT_EQ(stairs.around({0.5, 1}), 1);
    EXPECT_EQ(stairs.around({-0.5, 1}), 0);
    EXPECT_EQ(stairs.around({-0.5, 0}), 0);
}

TEST(WindingNumber, AgreesWithEverySegmentAskedInQuadruplePrecision) {
    std::mt19937_64 random(1);
    const auto number = [&random](double size) {
        return size * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    for (int round = 0; round < 50; ++round) {
        std::vector<Point2> points;
        for (int i = 0; i < 3 + round * 4; ++i)
            points.push_back(round % 2 == 0 ? Point2{number(10), number(10)}
                                            : Point2{static_cast<double>(random() % 8),
                                                     static_cast<double>(random() % 8)});
        const auto segments = closed(points);
        const WindingNumber asked(segments);
        for (int k = 0; k < 100; ++k) {
            const Point2 p{number(12) - 1, number(12) - 1};
            int expected = 0;
            for (const auto& [a, b] : segments) {
                const int side = test::sign(test::area(a, b, p));
                if (a.y <= p.y && p.y < b.y && side > 0) ++expected;
                if (b.y <= p.y && p.y < a.y && side < 0) --expected;
            }
            ASSERT_EQ(asked.around(p), expected) << "round " << round;
        }
    }
}

TEST(WindingNumber, TellsWhatIsClearOfAllSegments) {
    EXPECT_TRUE(WindingNumber({}).is_clear({0, 0}, 100));
    const WindingNumber flat(closed({{0, 1}, {5, 1}}));
    EXPECT_FALSE(flat.is_clear({2, 1.5}, 0.5));
    EXPECT_TRUE(flat.is_clear({2, 1.5}, 0.25));
    EXPECT_FALSE(flat.is_clear({5.5, 1}, 0.5));
    EXPECT_TRUE(flat.is_clear({6, 1}, 0.5));
    // So flat that rows are not to be numbered.
    const double least = std::numeric_limits<double>::denorm_min();
    const WindingNumber thin(closed({{0, 0}, {1, 0}, {1, least}}));
    EXPECT_EQ(thin.around({2, 0}), 0);
    EXPECT_FALSE(thin.is_clear({0.5, 0.5}, 0.5));
    EXPECT_TRUE(thin.is_clear({0.5, -0.75}, 0.5));
}

TEST(WindingNumber, WhatIsClearIsSoOfEachSegment) {
    std::mt19937_64 random(2);
    const auto number = [&random](double size) {
        return size * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    unsigned clear = 0, near = 0;
    for (int round = 0; round < 50; ++round) {
        std::vector<Point2> points;
        for (int i = 0; i < 3 + round; ++i)
            points.push_back({number(10), round % 2 == 0 ? number(10) : std::floor(number(8))});
        const auto segments = closed(points);
        const WindingNumber asked(segments);
        for (int k = 0; k < 100; ++k) {
            const Point2 p{number(14) - 2, number(14) - 2};
            const double distance = number(2);
            const bool expected = std::ranges::all_of(segments, [&](const DirectedSegment& s) {
                const double share = ((p.x - s.from.x) * (s.to.x - s.from.x) +
                                      (p.y - s.from.y) * (s.to.y - s.from.y)) /
                                     ((s.to.x - s.from.x) * (s.to.x - s.from.x) +
                                      (s.to.y - s.from.y) * (s.to.y - s.from.y));
                const double at = std::clamp(share, 0.0, 1.0);
                return std::hypot(s.from.x + (s.to.x - s.from.x) * at - p.x,
                                  s.from.y + (s.to.y - s.from.y) * at - p.y) > distance;
            });
            ASSERT_EQ(asked.is_clear(p, distance), expected) << "round " << round;
            ++(expected ? clear : near);
        }
    }
    EXPECT_GT(clear, 500u);
    EXPECT_GT(near, 500u);
}

}  // namespace
}  // namespace tinsmith::core
