// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_plan.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "api/side_by_side.hpp"
#include "tests/unit/api/formats/gltf_decoding.hpp"
#include "tests/unit/api/formats/gltf_matching.hpp"

namespace tinsmith::api {
namespace {

/// 600,000 triangles, longer than wide.
core::MeshData large() {
    return testing::hills(1200, 250, 2.0);
}

ScenePlan planned(const core::MeshData& mesh, const GltfOptions& options) {
    const auto grid = grid_for(in_metres(bounds_of(mesh), 1.0), options.tolerance);
    const auto points = quantize(mesh, 1.0, *grid).points;
    const SceneInput input{mesh, options, {}, {}};
    auto plan = plan_scene(input, *grid, points);
    EXPECT_TRUE(std::holds_alternative<ScenePlan>(plan));
    return std::get<ScenePlan>(std::move(plan));
}

TEST(PlanScene, HalvesALargeMeshAcrossItsLongerAxis) {
    const core::MeshData mesh = large();
    for (const Compression compression : {Compression::Draco, Compression::Meshopt}) {
        GltfOptions options;
        options.compression = compression;
        const ScenePlan plan = planned(mesh, options);
        ASSERT_EQ(plan.pieces.size(), 3u);
        EXPECT_EQ(plan.pieces[2].as, PlannedPiece::As::Lines);
        EXPECT_EQ(plan.pieces[2].items.size(), mesh.constraints.size());
        std::vector<std::uint32_t> all;
        std::array<double, 2> low{1e30, 1e30}, high{-1e30, -1e30};
        for (std::size_t i = 0; i < 2; ++i) {
            const Items& items = plan.pieces[i].items;
            EXPECT_NEAR(static_cast<double>(items.size()), 300'000.0, 1'000.0);
            all.insert(all.end(), items.begin(), items.end());
            for (const std::uint32_t t : items) {
                const double x = mesh.vertices[mesh.triangles[t][0]].x;
                low[i] = std::min(low[i], x);
                high[i] = std::max(high[i], x);
            }
        }
        EXPECT_LT(high[0], low[1]);
        std::ranges::sort(all);
        EXPECT_EQ(all, all_of(mesh.triangles.size()));
    }
}

TEST(PlanScene, LeavesASmallMeshWhole) {
    const core::MeshData mesh = testing::hills(700, 350, 2.0);  // 490,000
    EXPECT_EQ(planned(mesh, {}).pieces.size(), 2u);
}

TEST(PlanScene, EndsWhereAllTrianglesBeginAtOneVertex) {
    core::MeshData fan;
    fan.vertices = {{0, 0, 0}, {1000, 0, 0}};
    const auto count = static_cast<std::uint32_t>(kMostInOnePiece + 1);
    for (std::uint32_t i = 1; i <= count; ++i) {
        fan.vertices.push_back({1000.0, 2.0 * i, 0.0});
        fan.triangles.push_back({0, i, i + 1});
    }
    GltfOptions options;
    options.tolerance = 0.5;
    EXPECT_EQ(planned(fan, options).pieces.size(), 1u);
}

/// The last first.
void backwards(std::span<const core::Job> jobs) {
    for (std::size_t i = jobs.size(); i > 0; --i)
        jobs[i - 1]();
}

TEST(WriteGlb, IsTheSameHoweverItsJobsAreDoneAndHalvesMeet) {
    const core::MeshData mesh = large();
    const auto bytes_by = [&](const core::Executor& executor) {
        auto result = write_glb(mesh, {}, nullptr, executor);
        EXPECT_TRUE(std::holds_alternative<GltfResult>(result));
        EXPECT_EQ(std::get<GltfResult>(result).primitives, 2u);
        return std::get<GltfResult>(std::move(result)).bytes;
    };
    const std::string bytes = bytes_by(core::one_after_another);
    EXPECT_EQ(bytes_by(backwards), bytes);
    EXPECT_EQ(bytes_by(side_by_side), bytes);

    const testing::DecodedGlb glb = testing::decode_glb(bytes);
    ASSERT_EQ(glb.primitives.size(), 3u);
    std::set<std::array<float, 3>> positions;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        count += glb.primitives[i].positions.size();
        positions.insert(glb.primitives[i].positions.begin(), glb.primitives[i].positions.end());
    }
    // No position is there that only one of the halves has for its border.
    EXPECT_EQ(positions.size(), mesh.vertices.size());
    EXPECT_GT(count, mesh.vertices.size() + 250);
}

}  // namespace
}  // namespace tinsmith::api
