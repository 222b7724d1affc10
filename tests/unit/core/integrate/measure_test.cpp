// SPDX-License-Identifier: Apache-2.0
// What an operation's triangles are like is found at a glance where that is enough: the same as
// when each of them is measured.
#include "core/integrate/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/surface.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::built;
using test::ring;

/// Posts off the lattice by up to `jitter` cells, on one of several sorts of ground.
MeshData ground(double jitter, int sort, double scale) {
    constexpr std::uint32_t kPosts = 40;
    std::mt19937_64 random(5);
    const auto next = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
    MeshData mesh;
    for (std::uint32_t row = 0; row < kPosts; ++row) {
        for (std::uint32_t column = 0; column < kPosts; ++column) {
            const double x = 10.0 + column + jitter * next(), y = 10.0 + row + jitter * next();
            const double heights[] = {7.0, 7.0 + 0.25 * x, 9.0 + std::sin(x) * std::cos(0.7 * y),
                                      9.0 + 5.0 * next()};
            mesh.vertices.push_back({scale * x, scale * y, scale * heights[sort]});
        }
    }
    for (std::uint32_t row = 0; row + 1 < kPosts; ++row) {
        for (std::uint32_t column = 0; column + 1 < kPosts; ++column) {
            const std::uint32_t a = row * kPosts + column;
            mesh.triangles.push_back({a, a + 1, a + kPosts + 1});
            mesh.triangles.push_back({a, a + kPosts + 1, a + kPosts});
        }
    }
    return mesh;
}

struct Measured {
    std::vector<double> before, after;
    double steepest = 0.0;
};

Measured measured_one_by_one(const Tin& tin, const UndoRecord& record) {
    Measured all;
    const auto corner = [&](const Tin::Triangle& t, unsigned i) {
        return tin.vertex(t.vertices[i]).point();
    };
    const auto angle = [&](const Tin::Triangle& t) {
        return angle_degrees(smallest_angle_measure(corner(t, 0), corner(t, 1), corner(t, 2)));
    };
    for (const auto& [id, old] : record.triangles) {
        const Tin::Triangle& now = tin.triangle(id);
        if (now.vertices == old.vertices && now.facet == old.facet) continue;
        all.before.push_back(angle(old));
        all.after.push_back(angle(now));
        all.steepest =
            std::max(all.steepest, steepest_slope(corner(old, 0), corner(old, 1), corner(old, 2)));
    }
    for (std::size_t t = record.triangle_count; t < tin.triangle_count(); ++t)
        all.after.push_back(angle(tin.triangle({static_cast<std::uint32_t>(t)})));
    std::sort(all.before.begin(), all.before.end());
    std::sort(all.after.begin(), all.after.end());
    return all;
}

void expect_near(double measured, double expected) {
    EXPECT_NEAR(measured, expected, 1e-7 * expected);
}

TEST(MeasureOperation, FindsWhatMeasuringEachTriangleFinds) {
    for (const double scale : {1e-58, 1e-9, 1.0, 1e12}) {
        for (const double jitter : {0.0, 0.05, 0.2}) {
            for (int sort = 0; sort < 4; ++sort) {
                Tin tin = built(ground(jitter, sort, scale));
                std::vector<Point2> outline;
                for (int i = 0; i < 300; ++i) {
                    const double turn = 0.02 * i, reach = 11.0 + 3.0 * std::sin(9.0 * turn);
                    outline.push_back({scale * (29.7 + reach * std::cos(turn)),
                                       scale * (29.3 + reach * std::sin(turn))});
                }
                Undo undo;
                const auto report = integrate(tin, std::vector{ring(outline)}, {}, &undo);
                ASSERT_TRUE(report);
                const Measured each = measured_one_by_one(tin, undo.at(0));
                ASSERT_GT(each.before.size(), 200u);
                const Measurement found =
                    measure_operation(tin, {undo.at(0), tin.triangle_count()});
                const AngleSummary& angles = found.smallest_angle_deg;
                SCOPED_TRACE(::testing::Message() << scale << ' ' << jitter << ' ' << sort);
                expect_near(angles.before, each.before.front());
                expect_near(angles.after, each.after.front());
                expect_near(angles.p1_before, each.before[(each.before.size() - 1) / 100]);
                expect_near(angles.p1_after, each.after[(each.after.size() - 1) / 100]);
                expect_near(found.steepest_slope, each.steepest);
            }
        }
    }
}

}  // namespace
}  // namespace tinsmith::core
