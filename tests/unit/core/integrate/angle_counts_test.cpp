// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/angle_counts.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/surface.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::line;

AngleSteps steps(std::initializer_list<std::pair<std::size_t, std::uint64_t>> filled) {
    AngleSteps all{};
    for (const auto& [step, count] : filled)
        all[step] = count;
    return all;
}

/// The request's counts; nothing where it was refused.
AngleCounts counted(Tin& tin, const std::vector<Shape>& shapes,
                    const IntegrateOptions& options = {}) {
    Undo undo;
    const auto report = integrate(tin, shapes, options, &undo);
    EXPECT_TRUE(report) << report.errors().front().detail;
    return report ? count_angles(tin, undo) : AngleCounts{};
}

using Corners = std::array<Point3, 3>;

Corners corners_of(const MeshData& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

void add(const Corners& corners, AngleSteps& all) {
    const double angle = angle_degrees(smallest_angle_measure(corners[0], corners[1], corners[2]));
    ++all[std::min<std::size_t>(static_cast<std::size_t>(angle / kAngleStep + 1e-9), 11)];
}

/// What differs between two meshes, slot by slot, without a record of what was done.
AngleCounts compared(const MeshData& before, const MeshData& after) {
    AngleCounts counts;
    for (std::size_t t = 0; t < after.triangles.size(); ++t) {
        const bool is_new = t >= before.triangles.size();
        if (!is_new && corners_of(before, t) == corners_of(after, t)) continue;
        if (!is_new) add(corners_of(before, t), counts.before);
        add(corners_of(after, t), counts.after);
    }
    return counts;
}

TEST(AngleCounts, AreThoseOfATriangleSplitByAPoint) {
    // Of 45 degrees before, which no rounding takes down a step. After, at (6,0) and at (0,6)
    // atan(2 / 4), which is 26.57; of the third triangle, at both ends, 45 less that.
    Tin tin = built({{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}, {{0, 1, 2}}, {}});
    const AngleCounts counts = counted(tin, {line({{2, 2}})});
    EXPECT_EQ(counts.before, steps({{9, 1}}));
    EXPECT_EQ(counts.after, steps({{3, 1}, {5, 2}}));
}

TEST(AngleCounts, AreEmptyWhereNothingIsTouched) {
    Tin tin = built(grid(4, 4));
    const AngleCounts counts = counted(tin, {line({{1, 1}, {3, 1}})});
    EXPECT_EQ(counts.before, AngleSteps{});
    EXPECT_EQ(counts.after, AngleSteps{});
    EXPECT_EQ(count_angles(tin, {}).after, AngleSteps{});
}

TEST(AngleCounts, AreTheDifferenceOfTheMeshes) {
    std::mt19937 random(20261126);
    std::uniform_real_distribution<double> anywhere(0.5, 19.5), height(-2.0, 2.0);
    for (const Improve improve : {Improve::None, Improve::Strict, Improve::Paper}) {
        for (const bool own : {false, true}) {
            MeshData mesh = grid(20, 20);
            for (Point3& v : mesh.vertices)
                v.z = height(random);
            Tin tin = built(mesh);
            for (int round = 0; round < 8; ++round) {
                std::vector<Shape> shapes;
                for (int s = 0; s < 2; ++s) {
                    std::vector<Point2> points;
                    for (int i = 0; i < 4; ++i)
                        points.push_back({anywhere(random), anywhere(random)});
                    Shape shape = line(points);
                    if (own)
                        for (int i = 0; i < 4; ++i)
                            shape.paths[0].elevations.push_back(height(random));
                    shapes.push_back(std::move(shape));
                }
                IntegrateOptions options;
                options.improve = improve;
                const MeshData before = tin.to_data();
                const AngleCounts counts = counted(tin, shapes, options);
                const AngleCounts wanted = compared(before, tin.to_data());
                ASSERT_EQ(counts.before, wanted.before) << round;
                ASSERT_EQ(counts.after, wanted.after) << round;
                ASSERT_NE(counts.after, AngleSteps{});
            }
        }
    }
}

}  // namespace
}  // namespace tinsmith
