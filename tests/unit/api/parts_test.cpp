// SPDX-License-Identifier: Apache-2.0
#include "api/parts.hpp"

#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/gltf.hpp"
#include "api/formats/quantization.hpp"
#include "api/side_by_side.hpp"

namespace tinsmith::api {
namespace {

TEST(InParts, TakeEachItemOnce) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kLeastPart - 1, kLeastPart,
                                    3 * kLeastPart + 7, 100 * kLeastPart + 1}) {
        std::vector<unsigned char> taken(count);
        std::vector<Part> parts(kMostParts);
        std::atomic<std::size_t> calls{0};
        in_parts(side_by_side, count, [&](Part part) {
            ++calls;
            parts.at(part.number) = part;
            for (std::size_t i = part.begin; i < part.end; ++i)
                ++taken[i];
        });
        EXPECT_EQ(taken, std::vector<unsigned char>(count, 1));
        ASSERT_GE(calls, 1u) << count;
        for (std::size_t i = 0; i + 1 < calls; ++i) {
            EXPECT_EQ(parts[i].end, parts[i + 1].begin);
            EXPECT_GE(parts[i].end - parts[i].begin, kLeastPart);
        }
        EXPECT_EQ(parts[calls - 1].end, count);
    }
}

TEST(InParts, FollowOtherJobs) {
    std::vector<int> order;
    in_parts(core::one_after_another, 2 * kLeastPart,
             [&](Part part) { order.push_back(static_cast<int>(part.number)); },
             {[&] { order.push_back(-1); }});
    EXPECT_EQ(order, (std::vector<int>{-1, 0, 1}));
}

/// Bounds, errors and counts are put together from parts: extremes lie in the first and the last.
TEST(InParts, GiveWhatOnePassGives) {
    core::MeshData mesh;
    const std::size_t count = 3 * kLeastPart;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = static_cast<double>(i);
        mesh.vertices.push_back({x + 0.25, i % 2 == 0 ? 0.0 : 10.0, 0.001 * x});
    }
    mesh.vertices.back().y = 20.375;
    for (std::uint32_t i = 0; i + 2 < count; ++i)
        mesh.triangles.push_back({i, i + 1, i + 2});
    const Box<double> bounds = in_metres(bounds_of(mesh, side_by_side), 2.0);
    EXPECT_EQ(bounds.low, (std::array<double, 3>{0.5, 0.0, 0.0}));
    EXPECT_EQ(bounds.high[0], 2.0 * (static_cast<double>(count - 1) + 0.25));
    EXPECT_EQ(bounds.high[1], 40.75);
    const PositionGrid grid{{0.0, 0.0, 0.0}, 0};
    const GridVertices alone = quantize(mesh, 1.0, grid),
                       parted = quantize(mesh, 1.0, grid, side_by_side);
    EXPECT_EQ(alone.points, parted.points);
    EXPECT_EQ(alone.axis_error, parted.axis_error);
    EXPECT_EQ(parted.axis_error[0], 0.25);
    EXPECT_EQ(parted.axis_error[1], 0.375);
    const PlanCheck check = check_plan(parted.points, mesh.triangles, side_by_side);
    EXPECT_EQ(check.flipped, mesh.triangles.size() / 2) << "every other one is clockwise";
    EXPECT_EQ(check.collapsed, 0u);
}

TEST(InParts, SayWhichItemIsTheFirst) {
    core::MeshData mesh;
    mesh.vertices.resize(4 * kLeastPart);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        mesh.vertices[i] = {static_cast<double>(i), static_cast<double>(i % 3), 0.0};
    mesh.triangles.assign(4 * kLeastPart, {0, 1, 2});
    const auto says = [&] {
        const auto written = write_glb(mesh, {}, nullptr, side_by_side);
        const auto* error = std::get_if<EncodeError>(&written);
        return error == nullptr ? std::string("nothing") : error->detail;
    };
    mesh.triangles[3 * kLeastPart + 1] = {0, 0, 2};
    mesh.triangles[2 * kLeastPart - 1] = {0, 1, std::numeric_limits<std::uint32_t>::max()};
    EXPECT_NE(says().find("triangle " + std::to_string(2 * kLeastPart - 1)), std::string::npos)
        << says();
    mesh.vertices[4 * kLeastPart - 1].z = std::numeric_limits<double>::quiet_NaN();
    mesh.vertices[3 * kLeastPart].x = std::numeric_limits<double>::infinity();
    EXPECT_NE(says().find("vertex " + std::to_string(3 * kLeastPart)), std::string::npos) << says();
}

}  // namespace
}  // namespace tinsmith::api
