// SPDX-License-Identifier: Apache-2.0
// What rounding does to triangles in plan: found, told, and mended where a finer grid can.
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "api/formats/gltf.hpp"
#include "core/predicates/orientation.hpp"
#include "tests/unit/api/formats/gltf_decoding.hpp"
#include "tests/unit/api/formats/gltf_matching.hpp"

namespace tinsmith::api {
namespace {

using testing::DecodedGlb;
using testing::written;

TEST(PlanOfGlb, CountsWhatRoundingTurnsOver) {
    core::MeshData mesh;
    // On a grid of 1 m: the first stays; the second's apex, just above its base, rounds to 0 while
    // the base goes down from 1 to 0; the third rounds onto one line. The fourth is so large that
    // no finer grid is to be had.
    mesh.vertices = {{0, 20, 0},    {10, 20, 0},   {0, 30, 0},    {0, 0.6, 0},
                     {10, 0.4, 0},  {6, 0.49, 0},  {20, 10.1, 0}, {30, 10.2, 0},
                     {25, 10.3, 0}, {-4e6, 50, 0}, {4e6, 50, 0},  {0, 60, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
    GltfOptions options;
    options.tolerance = 0.6;
    const GltfResult coarse = written(mesh, options);
    EXPECT_EQ(coarse.step, 1.0);
    EXPECT_EQ(coarse.flipped, 1u);
    EXPECT_EQ(coarse.collapsed, 1u);
    const DecodedGlb glb = testing::decode_glb(coarse.bytes);
    const auto& extras = glb.json.at("scenes").at(0).at("extras");
    EXPECT_EQ(extras.at("collapsed"), coarse.collapsed);
    EXPECT_EQ(extras.at("flipped"), coarse.flipped);
    EXPECT_EQ(extras.at("max_error").get<double>(), coarse.max_error);
    EXPECT_EQ(extras.at("step").get<double>(), 1.0);
    EXPECT_EQ(extras.at("origin"), nlohmann::json(coarse.origin));
    EXPECT_EQ(extras.at("triangles"), mesh.triangles.size());
}

TEST(PlanOfGlb, TakesAFinerGridWhereThatKeepsTriangles) {
    core::MeshData mesh;
    mesh.vertices = {{0, 20, 0},   {10, 20, 0},   {0, 30, 0},    {0, 0.6, 0},  {10, 0.4, 0},
                     {6, 0.49, 0}, {20, 10.1, 0}, {30, 10.2, 0}, {25, 10.3, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    for (const Compression compression : {Compression::Draco, Compression::Meshopt}) {
        GltfOptions options;
        options.compression = compression;
        options.tolerance = 0.6;
        const GltfResult result = written(mesh, options);
        EXPECT_EQ(result.flipped + result.collapsed, 0u);
        EXPECT_LT(result.step, 1.0);
        EXPECT_GE(result.step, 0x1p-4) << "no finer than need be";
        // One that no grid can help costs nothing.
        core::MeshData needle = mesh;
        needle.vertices.push_back({5 + 1e-12, 20, 0});
        needle.triangles.push_back({0, 1, 9});
        const GltfResult hopeless = written(needle, options);
        EXPECT_EQ(hopeless.collapsed, 1u);
        EXPECT_EQ(hopeless.step, result.step);
    }
}

TEST(PlanOfGlb, PlainFlipsAreThoseOfTheFloats) {
    // Near 60 km a float32 step is 2^-8 m: the sliver's apex falls onto its base.
    core::MeshData mesh;
    mesh.vertices = {{-60000, -60000, 0},     {60000, -60000, 0},    {60000, 60000, 0},
                     {0, 0.0004, 0},          {59000.5, 59000.5, 0}, {59001.5, 59001.5, 0},
                     {59001.0, 59001.0005, 0}};
    mesh.triangles = {{0, 1, 2}, {4, 5, 6}, {0, 2, 3}};
    const GltfResult result = written(mesh, {.compression = Compression::None});
    EXPECT_EQ(result.collapsed, 1u);
    EXPECT_EQ(result.flipped, 0u);
}

TEST(PlanOfGlb, PlainFlipsOfNeedlesAreThoseOfTheFloats) {
    std::mt19937_64 random(11);
    const auto next = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
    for (const double size : {1e-25, 1e-10, 1.0, 1e5, 1e12}) {
        for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
            core::MeshData mesh;
            for (std::uint32_t i = 0; i < 900; i += 3) {
                const core::Point3 a{size * next(), size * next(), 0},
                    c{size * next(), size * next(), 0};
                const double share = 0.5 + 0.4 * next(), off = 1e-7 * next();
                mesh.vertices.insert(mesh.vertices.end(),
                                     {a,
                                      {a.x + (c.x - a.x) * share - (c.y - a.y) * off,
                                       a.y + (c.y - a.y) * share + (c.x - a.x) * off, 0},
                                      c});
                mesh.triangles.push_back({i, i + 1, i + 2});
            }
            const GltfResult result =
                written(mesh, {.compression = Compression::None, .tolerance = 1e6, .up = up});
            const DecodedGlb glb = testing::decode_glb(result.bytes);
            const auto& positions = glb.primitives.at(0).positions;
            const auto plan = [&](std::uint32_t v) {
                const auto& [x, y, z] = positions.at(v);
                return up == UpAxis::Z ? core::Point2{double{x}, double{y}}
                                       : core::Point2{double{x}, -double{z}};
            };
            std::size_t flipped = 0, collapsed = 0;
            for (const auto& [a, b, c] : mesh.triangles) {
                const core::Orientation side = core::orientation(plan(a), plan(b), plan(c));
                flipped += side == core::Orientation::Clockwise ? 1 : 0;
                collapsed += side == core::Orientation::Collinear ? 1 : 0;
            }
            EXPECT_EQ(result.flipped, flipped) << size;
            EXPECT_EQ(result.collapsed, collapsed) << size;
            EXPECT_GT(flipped, 50u);
            EXPECT_LT(flipped + collapsed, 250u);
        }
    }
}

}  // namespace
}  // namespace tinsmith::api
