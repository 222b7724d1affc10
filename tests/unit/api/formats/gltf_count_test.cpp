// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_count.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

constexpr std::size_t kMany = 1'000'000;

GltfPrimitive primitive(std::size_t mode, std::size_t accessor) {
    GltfPrimitive made;
    made.mode = mode;
    made.indices = accessor;
    return made;
}

/// A mesh of two triangles, a strip of three, a fan of one, and a line.
GltfModel model() {
    GltfModel model;
    for (const std::size_t count : {6U, 5U, 3U, 2U}) {
        GltfAccessor accessor;
        accessor.count = count;
        model.accessors.push_back(accessor);
    }
    model.meshes.push_back({primitive(4, 0), primitive(5, 1), primitive(6, 2), primitive(1, 3)});
    return model;
}

void show(GltfModel& model, std::size_t places) {
    for (std::size_t i = 0; i < places; ++i) {
        model.roots.push_back(model.nodes.size());
        model.nodes.emplace_back().mesh = 0;
    }
}

TEST(GltfCount, CountsEachMeshInEachOfItsPlaces) {
    GltfModel scene = model();
    EXPECT_EQ(told_triangles(scene, kMany), 0U);
    show(scene, 7);
    EXPECT_EQ(told_triangles(scene, kMany), 7U * 6U);
    scene.nodes.emplace_back().mesh = 0;  // not in the scene
    EXPECT_EQ(told_triangles(scene, kMany), 7U * 6U);
    EXPECT_GT(told_triangles(scene, 41), 41U);
    EXPECT_EQ(told_triangles(scene, 42), 42U);
}

TEST(GltfCount, EndsWhateverNodesSay) {
    GltfModel scene = model();
    show(scene, 2);
    scene.nodes[0].children = {1, 0, 99};
    scene.nodes[1].children = {0};
    EXPECT_EQ(told_triangles(scene, kMany), 12U);
    scene.nodes[0].mesh = 99;
    EXPECT_EQ(told_triangles(scene, kMany), 6U);
}

TEST(GltfCount, LeavesNumbersThatCannotBeToTheBytes) {
    GltfModel scene = model();
    show(scene, 2);
    scene.accessors[0].count = static_cast<std::size_t>(-1);
    EXPECT_EQ(told_triangles(scene, 1000), 2U * 4U);
    scene.meshes[0] = {primitive(4, 99), GltfPrimitive{}};
    EXPECT_EQ(told_triangles(scene, 1000), 0U);
}

}  // namespace
}  // namespace tinsmith::api
