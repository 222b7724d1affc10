// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/api/formats/gltf_decoding.hpp"
#include "tests/unit/api/formats/gltf_matching.hpp"

namespace tinsmith::api {
namespace {

using testing::DecodedGlb;
using testing::DecodedPrimitive;
using testing::expect_same_lines;
using testing::expect_same_mesh;
using testing::hills;
using testing::NearestVertex;
using testing::placed;
using testing::written;

EncodeError refused(const core::MeshData& mesh, const GltfOptions& options) {
    const auto result = write_glb(mesh, options);
    EXPECT_TRUE(std::holds_alternative<EncodeError>(result));
    if (const auto* error = std::get_if<EncodeError>(&result)) return *error;
    return {};
}

TEST(WriteGlb, DracoHoldsTheMeshWithinTheTolerance) {
    const core::MeshData mesh = hills(60, 40, 30);
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        for (const double unit : {1.0, 0.3048}) {
            GltfOptions options;
            options.up = up;
            options.unit_to_metre = unit;
            const GltfResult result = written(mesh, options);
            const DecodedGlb glb = testing::decode_glb(result.bytes);
            expect_same_mesh(mesh, options, glb);
            expect_same_lines(mesh, options, glb);
            EXPECT_EQ(glb.primitives.size(), 2u);
            EXPECT_EQ(result.primitives, 1u);
            EXPECT_EQ(result.nodes, 1u);
            EXPECT_EQ(result.step, 0x1p-7);
            EXPECT_LE(result.max_error, 0x1p-8 * 1.000001);
            EXPECT_GT(result.max_error, 0x1p-8 * 0.9);
            EXPECT_EQ(result.flipped + result.collapsed, 0u);
            EXPECT_EQ(glb.json.at("extensionsRequired"), glb.json.at("extensionsUsed"));
            EXPECT_EQ(glb.json.at("extensionsUsed"),
                      nlohmann::json::array({"KHR_draco_mesh_compression"}));
        }
    }
}

TEST(WriteGlb, TurnsZUpIntoYUp) {
    core::MeshData mesh;
    mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 20, 6}};
    mesh.triangles = {{0, 1, 2}};
    const GltfResult result = written(mesh, {.compression = Compression::None});
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    EXPECT_EQ(result.origin, (std::array<double, 3>{5, 10, 3}));
    EXPECT_EQ(glb.primitives.at(0).translation, (std::array<double, 3>{5, 3, -10}));
    EXPECT_EQ(glb.primitives[0].positions,
              (std::vector<std::array<float, 3>>{{-5, -3, 10}, {5, -3, 10}, {-5, 3, -10}}));
    // Counter-clockwise as seen from +y.
    EXPECT_EQ(glb.primitives[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(WriteGlb, PlainKeepsSlotOrder) {
    const core::MeshData mesh = hills(30, 20, 25);
    GltfOptions options;
    options.compression = Compression::None;
    const GltfResult result = written(mesh, options);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    expect_same_mesh(mesh, options, glb);
    expect_same_lines(mesh, options, glb);
    EXPECT_FALSE(glb.json.contains("extensionsUsed"));
    const DecodedPrimitive& primitive = glb.primitives.at(0);
    ASSERT_EQ(primitive.positions.size(), mesh.vertices.size());
    double largest = 0;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        const core::Point3 p = placed(primitive, i, true), v = mesh.vertices[i];
        largest =
            std::max({largest, std::fabs(p.x - v.x), std::fabs(p.y - v.y), std::fabs(p.z - v.z)});
    }
    EXPECT_EQ(result.max_error, largest);
    EXPECT_EQ(primitive.indices[3], mesh.triangles[1][0]);
    EXPECT_EQ(result.bits, 0u);
}

TEST(WriteGlb, MeasuresWhatClientsSee) {
    const core::MeshData mesh = hills(50, 50, 12);
    GltfOptions options;
    options.tolerance = 0.1;
    const GltfResult result = written(mesh, options);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    const NearestVertex nearest(mesh, 1.0, 0.1);
    std::array<double, 3> largest{};
    const DecodedPrimitive& primitive = glb.primitives.at(0);
    for (std::uint32_t i = 0; i < primitive.positions.size(); ++i) {
        const core::Point3 p = placed(primitive, i, true);
        const core::Point3 v = mesh.vertices[nearest(p)];
        largest = {std::max(largest[0], std::fabs(p.x - v.x)),
                   std::max(largest[1], std::fabs(p.y - v.y)),
                   std::max(largest[2], std::fabs(p.z - v.z))};
    }
    EXPECT_EQ(result.axis_error, largest);
    EXPECT_EQ(result.max_error, std::max({largest[0], largest[1], largest[2]}));
}

/// Positions that more than one triangle primitive has, each with how many have it.
std::size_t shared_positions(const DecodedGlb& glb) {
    std::map<std::array<double, 3>, std::size_t> count;
    for (const DecodedPrimitive& primitive : glb.primitives) {
        if (primitive.mode != 4) continue;
        std::set<std::array<double, 3>> own;
        for (std::uint32_t i = 0; i < primitive.positions.size(); ++i) {
            const auto p = placed(primitive, i, true);
            own.insert({p.x, p.y, p.z});
        }
        for (const auto& p : own)
            ++count[p];
    }
    return static_cast<std::size_t>(std::count_if(
        count.begin(), count.end(), [](const auto& entry) { return entry.second > 1; }));
}

/// Vertices of the mesh that triangles of more than one primitive use.
std::size_t border_vertices(const core::MeshData& mesh, const DecodedGlb& glb, double tolerance) {
    const NearestVertex nearest(mesh, 1.0, tolerance);
    std::vector<std::set<std::size_t>> users(mesh.vertices.size());
    for (std::size_t k = 0; k < glb.primitives.size(); ++k) {
        if (glb.primitives[k].mode != 4) continue;
        for (std::uint32_t i = 0; i < glb.primitives[k].positions.size(); ++i)
            users[nearest(placed(glb.primitives[k], i, true))].insert(k);
    }
    return static_cast<std::size_t>(std::count_if(
        users.begin(), users.end(), [](const auto& user) { return user.size() > 1; }));
}

TEST(WriteGlb, AWideMeshIsCutWithoutASeam) {
    // 12 km at 2^-10 m: 2^23.5 steps, so more than one primitive but one node.
    const core::MeshData mesh = hills(60, 60, 200);
    GltfOptions options;
    options.tolerance = 0x1p-10;
    const GltfResult result = written(mesh, options);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    EXPECT_EQ(result.primitives, 4u);
    EXPECT_EQ(result.nodes, 1u);
    EXPECT_EQ(result.bits, 23u);
    expect_same_mesh(mesh, options, glb);
    expect_same_lines(mesh, options, glb);
    const std::size_t border = border_vertices(mesh, glb, options.tolerance);
    EXPECT_GT(border, 60u);
    EXPECT_EQ(shared_positions(glb), border) << "a border vertex differs between primitives";
}

TEST(WriteGlb, BeyondOneNodesFloatsEachPrimitiveHasANode) {
    // 12 km at 2^-12 m: 2^25.5 steps.
    const core::MeshData mesh = hills(40, 40, 300);
    GltfOptions options;
    options.tolerance = 0x1p-12;
    const GltfResult result = written(mesh, options);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    EXPECT_EQ(result.nodes, glb.primitives.size());
    EXPECT_GT(result.nodes, result.primitives);
    expect_same_mesh(mesh, options, glb);
    expect_same_lines(mesh, options, glb);
    EXPECT_EQ(shared_positions(glb), border_vertices(mesh, glb, options.tolerance));
}

TEST(WriteGlb, HugeTrianglesGoUncompressedOnTheSameGrid) {
    core::MeshData mesh = hills(20, 20, 100, {0, 0, 0});
    // A skirt of two triangles 100 km wide beside the hills, on their south-west corner.
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({100000.1, -50000.2, 3.3});
    mesh.vertices.push_back({-30000.7, -50000.4, 7.7});
    mesh.triangles.push_back({first + 1, first, 0});
    const GltfOptions options;
    const GltfResult result = written(mesh, options);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    EXPECT_EQ(result.primitives, 2u);
    EXPECT_EQ(result.nodes, 1u);
    expect_same_mesh(mesh, options, glb);
    EXPECT_EQ(shared_positions(glb), 1u);

    core::MeshData alone{mesh.vertices, {{first + 1, first, 0}}, {}};
    alone.vertices[1] = alone.vertices[0];
    const DecodedGlb plain = testing::decode_glb(written(alone, options).bytes);
    EXPECT_FALSE(plain.json.contains("extensionsRequired"));
}

TEST(WriteGlb, LeavesOutWhatIsNotAskedFor) {
    core::MeshData mesh = hills(5, 5, 10);
    for (const Compression compression : {Compression::Draco, Compression::None}) {
        GltfOptions options;
        options.compression = compression;
        options.constraints = false;
        options.normals = false;
        const DecodedGlb glb = testing::decode_glb(written(mesh, options).bytes);
        ASSERT_EQ(glb.primitives.size(), 1u);
        EXPECT_TRUE(glb.primitives[0].normals.empty());
        options.constraints = true;
        core::MeshData without = mesh;
        without.constraints.clear();
        EXPECT_EQ(testing::decode_glb(written(without, options).bytes).primitives.size(), 1u);
    }
}

TEST(WriteGlb, GivesTheSameBytesAgain) {
    const core::MeshData mesh = hills(40, 40, 300);
    for (const double tolerance : {0.005, 0.0005}) {
        GltfOptions options;
        options.tolerance = tolerance;
        EXPECT_EQ(written(mesh, options).bytes, written(mesh, options).bytes);
    }
}

TEST(WriteGlb, RefusesWhatDracoTakesForGranted) {
    const core::MeshData good = hills(2, 2, 10);
    EXPECT_EQ(refused({}, {}).fault, EncodeFault::BadMesh);
    core::MeshData bad = good;
    bad.vertices[3].z = std::nan("");
    EXPECT_EQ(refused(bad, {}).detail, "a coordinate that is not finite or too large at vertex 3");
    bad = good;
    bad.triangles[2][1] = 9;
    EXPECT_EQ(refused(bad, {}).detail, "a wrong vertex index in triangle 2");
    bad = good;
    bad.triangles[2][1] = bad.triangles[2][2];
    EXPECT_EQ(refused(bad, {}).fault, EncodeFault::BadMesh);
    bad = good;
    bad.constraints.push_back({4, 9});
    EXPECT_EQ(refused(bad, {}).fault, EncodeFault::BadMesh);
    for (const double number : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_EQ(refused(good, {.tolerance = number}).fault, EncodeFault::BadOption);
        EXPECT_EQ(refused(good, {.unit_to_metre = number}).fault, EncodeFault::BadOption);
    }
}

TEST(WriteGlb, SaysWhichToleranceItCanHold) {
    const core::MeshData mesh = hills(40, 40, 1000);
    const EncodeError error = refused(mesh, {.tolerance = 1e-6});
    EXPECT_EQ(error.fault, EncodeFault::ToleranceTooFine);
    EXPECT_EQ(error.detail,
              "too fine for a mesh of this extent; ask for tolerance=3.0517578125e-05 or coarser");
    const EncodeError plain = refused(mesh, {.compression = Compression::None, .tolerance = 1e-4});
    EXPECT_EQ(plain.fault, EncodeFault::ToleranceTooFine);
    EXPECT_NE(plain.detail.find("or coarser"), std::string::npos);
}

TEST(WriteGlb, HoldsExtremeExtents) {
    for (const double cell : {1e-3, 1e6, 1e11}) {
        const core::MeshData mesh = hills(8, 8, cell, {1e6, -2e6, 5});
        GltfOptions options;
        options.tolerance = std::max(cell * 1e-3, 1e-6);
        expect_same_mesh(mesh, options, testing::decode_glb(written(mesh, options).bytes));
    }
}

TEST(WriteGlb, HasMaterialsThatLookRightElsewhere) {
    for (const Compression compression :
         {Compression::Draco, Compression::Meshopt, Compression::None}) {
        for (const bool constraints : {true, false}) {
            GltfOptions options;
            options.compression = compression;
            options.constraints = constraints;
            options.tolerance = 1.0;
            const DecodedGlb glb =
                testing::decode_glb(written(testing::hills(6, 5, 30), options).bytes);
            const auto& materials = glb.json.at("materials");
            EXPECT_EQ(materials.size(), constraints ? 2U : 1U) << "none that is not used";
            for (const DecodedPrimitive& primitive : glb.primitives) {
                const auto& material =
                    materials.at(primitive.json.at("material").get<std::size_t>());
                EXPECT_EQ(material.at("name"), primitive.mode == 1 ? "constraints" : "terrain");
                EXPECT_EQ(material.at("doubleSided"), true);
                const auto& look = material.at("pbrMetallicRoughness");
                EXPECT_EQ(look.at("metallicFactor"), 0.0);
                EXPECT_EQ(look.at("roughnessFactor"), 0.9);
                const auto& color = look.at("baseColorFactor");
                EXPECT_EQ(color[0], color[1]);
                EXPECT_EQ(color[1], color[2]);
                EXPECT_EQ(color[3], 1.0);
            }
        }
    }
}

TEST(WriteGlb, TellsTheSystemIfThereIsOne) {
    GltfOptions options;
    const core::MeshData mesh = testing::hills(2, 2, 30);
    const auto extras = [&] {
        return testing::decode_glb(written(mesh, options).bytes)
            .json.at("scenes")
            .at(0)
            .at("extras");
    };
    EXPECT_FALSE(extras().contains("crs"));
    options.crs = "EPSG:2264";
    EXPECT_EQ(extras().at("crs"), "EPSG:2264");
}

}  // namespace
}  // namespace tinsmith::api
