// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_normals.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

/// A vertex in the middle of a fan over the plane z = slope x, far from the origin, with spokes of
/// very different lengths: most triangles are needles.
core::MeshData fan_on_slope(double slope, double size) {
    core::MeshData mesh;
    const double x = 5e5 * size, y = 4e6 * size;
    mesh.vertices.push_back({x, y, slope * x});
    constexpr std::uint32_t kSpokes = 400;
    for (std::uint32_t i = 0; i < kSpokes; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / kSpokes;
        const double length = (i % 3 == 0 ? 1e3 : 2e-1) * size;
        const double east = x + length * std::cos(turn);
        mesh.vertices.push_back({east, y + length * std::sin(turn), slope * east});
        mesh.triangles.push_back({0, i + 1, (i + 1) % kSpokes + 1});
    }
    return mesh;
}

TEST(SmoothNormal, IsTheirsWhereNeedlesMeet) {
    for (const double slope : {0.0, 0.5, 3.0}) {
        const core::MeshData mesh = fan_on_slope(slope, 1.0);
        const double length = std::sqrt(1.0 + slope * slope);
        for (const NormalSum& sum : normal_sums(mesh)) {
            const auto [east, north, up] = smooth_normal(sum, UpAxis::Z);
            EXPECT_NEAR(east, -slope / length, 2e-6);
            EXPECT_NEAR(north, 0.0, 2e-6);
            EXPECT_NEAR(up, 1.0 / length, 2e-6);
        }
    }
}

/// Squares of the sums would be zero or infinite in float32.
TEST(SmoothNormal, IsOfLengthOneForTinyAndHugeTriangles) {
    for (const double size : {1e-14, 1e-9, 1e6, 1e8}) {
        const core::MeshData mesh = fan_on_slope(1.0, size);
        const auto [east, north, up] = smooth_normal(normal_sums(mesh)[0], UpAxis::Z);
        EXPECT_NEAR(east, -std::sqrt(0.5), 2e-6) << size;
        EXPECT_NEAR(north, 0.0, 2e-6) << size;
        EXPECT_NEAR(up, std::sqrt(0.5), 2e-6) << size;
    }
}

TEST(SmoothNormal, PointsUpWhereThereIsNone) {
    EXPECT_EQ(smooth_normal(NormalSum{}, UpAxis::Z), (std::array{0.0F, 0.0F, 1.0F}));
    EXPECT_EQ(smooth_normal(NormalSum{}, UpAxis::Y), (std::array{0.0F, 1.0F, 0.0F}));
}

}  // namespace
}  // namespace tinsmith::api
