// SPDX-License-Identifier: Apache-2.0
#include "api/ring_offset.hpp"

#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "core/edit/cutout.hpp"

namespace tinsmith::api {
namespace {

using core::Path;
using core::Shape;
using core::Winding;

Path box(double x0, double y0, double x1, double y1) {
    return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, true, {}};
}

double area_of(const Shape& shape) {
    return *core::area_inside(shape, Winding::EvenOdd);
}

RingOffset inside(const Shape& shape, double distance, Winding winding = Winding::EvenOdd) {
    return std::get<RingOffset>(ring_inside(*core::triangles_inside(shape, winding), distance));
}

RingOffset outside(const Shape& shape, double distance) {
    return std::get<RingOffset>(
        ring_outside(*core::triangles_inside(shape, Winding::EvenOdd), distance));
}

NoRing no_ring(const Shape& shape, double distance) {
    return std::get<NoRing>(
        ring_inside(*core::triangles_inside(shape, Winding::EvenOdd), distance));
}

TEST(RingOffset, OfASquareIsASquareOrARoundedOne) {
    const Shape square{{box(5e6, 5e6, 5e6 + 100, 5e6 + 100)}};
    const RingOffset within = inside(square, 0.05);
    ASSERT_EQ(within.ring.paths.size(), 1U);
    EXPECT_EQ(within.ring.paths[0].points.size(), 4U);
    for (const core::Point2 p : within.ring.paths[0].points) {
        EXPECT_NEAR(std::fabs(p.x - (5e6 + 50)), 49.95, 2e-9);
        EXPECT_NEAR(std::fabs(p.y - (5e6 + 50)), 49.95, 2e-9);
    }
    const RingOffset around = outside(square, 10);
    ASSERT_EQ(around.ring.paths.size(), 1U);
    EXPECT_EQ(around.ring.paths[0].points.size(), 4U * 9U);
    EXPECT_EQ(area_of(around.border), 1e4);
    EXPECT_NEAR(area_of(around.ring), 1e4 + 4 * 1000 + 3.1415926 * 100, 3.0);
}

TEST(RingOffset, GoesBothWaysAtAHole) {
    const Shape holed{{box(0, 0, 10, 10), box(4, 4, 6, 6)}};
    EXPECT_NEAR(area_of(inside(holed, 1).ring), 64 - 16, 1e-9);
    EXPECT_EQ(inside(holed, 1).ring.paths.size(), 2U);
    EXPECT_EQ(outside(holed, 0.5).ring.paths.size(), 2U);
    EXPECT_EQ(outside(holed, 1.5).ring.paths.size(), 1U) << "the hole closes";
}

TEST(RingOffset, OfCrossingLinesIsByTheWindingRuleWhicheverWayTheyRun) {
    Path bow{{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, true, {}};
    for (int turned = 0; turned < 2; ++turned) {
        const RingOffset two = inside({{bow}}, 0.1);
        EXPECT_EQ(two.ring.paths.size(), 2U);
        EXPECT_NEAR(area_of(two.border), 8, 1e-12);
        std::reverse(bow.points.begin(), bow.points.end());
    }
    const Shape overlapping{{box(0, 0, 4, 4), box(2, 0, 6, 4)}};
    EXPECT_NEAR(area_of(inside(overlapping, 0.5).border), 16, 1e-12);
    EXPECT_NEAR(area_of(inside(overlapping, 0.5, Winding::NonZero).border), 24, 1e-12);
    EXPECT_NEAR(area_of(inside(overlapping, 0.5, Winding::NonZero).ring), 15, 1e-9);
}

TEST(RingOffset, TakesAnAreaThatTouchesItselfAroundAnotherPlace) {
    const Shape crossing{
        {{{{0, 9.3}, {7.7, 4}, {0.1, 8.2}, {3.4, 5}, {3.2, 8.3}, {2.3, 0.7}}, true, {}}}};
    EXPECT_NEAR(area_of(inside(crossing, 0.001).border), 11.09, 0.01);
    EXPECT_LT(area_of(inside(crossing, 0.001).ring), area_of(crossing));
    EXPECT_GT(area_of(outside(crossing, 1.0).ring), area_of(crossing));
    const Shape holes{{box(0, 0, 10, 10), box(2, 2, 6, 6), box(4, 4, 8, 8)}};
    EXPECT_NEAR(area_of(inside(holes, 0.01).border), 100 - 24, 1e-9);
}

TEST(RingOffset, SaysWhatAThinPartBears) {
    const NoRing thin = no_ring({{box(0, 0, 100, 1)}}, 2);
    EXPECT_EQ(thin.reason, NoRing::Reason::TooThin);
    EXPECT_GT(thin.limit, 0.49);
    EXPECT_LT(thin.limit, 0.5);
    const Shape both{{box(0, 0, 100, 1), box(0, 10, 100, 100)}};
    EXPECT_EQ(no_ring(both, 2).limit, thin.limit) << "one part alone is too thin";
    inside(both, thin.limit);
    // A sliver, in which the largest circle is searched for long.
    const NoRing sliver = no_ring({{box(0, 0, 1e3, 1e-7)}}, 0.05);
    EXPECT_EQ(sliver.reason, NoRing::Reason::TooThin);
    EXPECT_GT(sliver.limit, 4e-8);
}

TEST(RingOffset, RefusesWhatHasNoInsideOrIsLostInRounding) {
    EXPECT_EQ(no_ring({{{{{0, 0}, {5, 5}, {10, 10}}, true, {}}}}, 1).reason, NoRing::Reason::Empty);
    EXPECT_EQ(no_ring({{{{{3, 3}}, true, {}}}}, 1).reason, NoRing::Reason::Empty);
    const NoRing small = no_ring({{box(5e6, 5e6, 5e6 + 1, 5e6 + 1)}}, 1e-9);
    EXPECT_EQ(small.reason, NoRing::Reason::TooSmall);
    EXPECT_GT(small.limit, 1e-9);
}

/// Spikes that lie close together: their offset lines cross one another everywhere.
Shape star(int spikes) {
    Path path{{}, true, {}};
    for (int i = 0; i < 2 * spikes; ++i) {
        const double radius = i % 2 == 0 ? 100 : 90, angle = M_PI * i / spikes;
        path.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return {{path}};
}

TEST(RingOffset, StopsInTheMidstOfWhatTakesLong) {
    const auto area = core::triangles_inside(star(1000), Winding::EvenOdd);
    for (const bool is_inside : {false, true}) {
        const auto offset = [&](const std::function<bool()>& stop) {
            return is_inside ? ring_inside(*area, 10, stop) : ring_outside(*area, 10, stop);
        };
        // How often it is asked is the library's choice, and differs from release to release.
        int all = 0;
        offset([&all] { return ++all < 0; });
        ASSERT_GT(all, 10);
        int asked = 0;
        const auto made = offset([&] { return ++asked > all / 2; });
        ASSERT_TRUE(std::holds_alternative<NoRing>(made));
        EXPECT_EQ(std::get<NoRing>(made).reason, NoRing::Reason::Stopped);
        EXPECT_EQ(asked, all / 2 + 1) << "and is not asked again";
    }
    outside(star(5), 10);  // what comes later is not told
}

TEST(RingOffset, WhoIsToldToStopStopsAlone) {
    std::atomic<bool> ended{false};
    std::thread told([&ended] {
        const auto area = core::triangles_inside(star(50), Winding::EvenOdd);
        while (!ended) {
            const auto made = ring_outside(*area, 10, [] { return true; });
            EXPECT_EQ(std::get<NoRing>(made).reason, NoRing::Reason::Stopped);
        }
    });
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(outside(star(50), 10).ring.paths.size(), 1U);
    ended = true;
    told.join();
}

}  // namespace
}  // namespace tinsmith::api
