// SPDX-License-Identifier: Apache-2.0
#include "api/formats/glb_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_document.hpp"
#include "core/mesh/build.hpp"
#include "tests/unit/api/formats/glb_bytes.hpp"

namespace tinsmith::api {
namespace {

using nlohmann::json;
using testing::bytes_of;
using testing::glb_of;
using testing::square_bin;
using testing::square_document;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

const std::vector<core::Point3> kSquare{{0, 0, 1}, {4, 0, 2}, {4, 4, 3}, {0, 4, 4}};

std::string codes(const std::string& bytes, const ReadLimits& limits = {}) {
    const auto read = read_glb(bytes, limits);
    if (read) return "";
    std::string out;
    for (const Fault& fault : read.faults())
        out += (out.empty() ? "" : " ") + fault.code + fault.pointer;
    return out;
}

/// The square with something else in its document.
std::string changed(const std::function<void(json&)>& change, std::string bin = square_bin()) {
    json document = square_document();
    change(document);
    return glb_of(document, std::move(bin));
}

core::MeshData terrain(double origin) {
    core::MeshData mesh;
    constexpr std::uint32_t kSide = 30;
    for (std::uint32_t r = 0; r < kSide; ++r)
        for (std::uint32_t c = 0; c < kSide; ++c)
            mesh.vertices.push_back({origin + 10.0 * c, origin + 10.0 * r,
                                     300 + 5 * std::sin(c * 0.7) * std::cos(r * 0.4)});
    for (std::uint32_t r = 0; r + 1 < kSide; ++r)
        for (std::uint32_t c = 0; c + 1 < kSide; ++c) {
            const std::uint32_t a = r * kSide + c;
            mesh.triangles.push_back({a, a + 1, a + kSide + 1});
            mesh.triangles.push_back({a, a + kSide + 1, a + kSide});
        }
    for (std::uint32_t c = 0; c + 1 < kSide; ++c)
        mesh.constraints.push_back({5 * kSide + c, 5 * kSide + c + 1});
    return mesh;
}

TEST(GlbReader, ReadsItsOwnPlainFilesExactly) {
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        const core::MeshData mesh = terrain(4'026'000.25);
        GltfOptions options;
        options.compression = Compression::None;
        options.up = up;
        options.tolerance = 1;
        const auto written = write_glb(mesh, options);
        const auto& file = std::get<GltfResult>(written);
        const auto read = read_glb(file.bytes, {});
        ASSERT_TRUE(read) << read.faults().front().detail;
        EXPECT_EQ(read->mesh.triangles, mesh.triangles);
        EXPECT_EQ(read->mesh.constraints.size(), mesh.constraints.size());
        ASSERT_EQ(read->mesh.vertices.size(), mesh.vertices.size());
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const auto near = [&](double value, double origin) {
                return origin + double{static_cast<float>(value - origin)};
            };
            const core::Point3& p = mesh.vertices[i];
            EXPECT_EQ(read->mesh.vertices[i],
                      (core::Point3{near(p.x, file.origin[0]), near(p.y, file.origin[1]),
                                    near(p.z, file.origin[2])}));
        }
        EXPECT_TRUE(core::build_tin(read->mesh));
        EXPECT_TRUE(read->notes.empty());
    }
}

TEST(GlbReader, ReadsItsOwnDracoFilesWithinTheTolerance) {
    const core::MeshData mesh = terrain(757'400.0);
    GltfOptions options;
    options.unit_to_metre = 0.3048;
    const auto written = write_glb(mesh, options);
    const auto read = read_glb(std::get<GltfResult>(written).bytes, {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->unit, "metre");
    EXPECT_EQ(read->mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(read->mesh.constraints.size(), mesh.constraints.size());
    ASSERT_EQ(read->mesh.vertices.size(), mesh.vertices.size());
    for (const core::Point3& v : mesh.vertices) {
        const bool found = std::any_of(read->mesh.vertices.begin(), read->mesh.vertices.end(),
                                       [&](const core::Point3& p) {
                                           return std::fabs(p.x - v.x * 0.3048) <= 0.005 &&
                                                  std::fabs(p.y - v.y * 0.3048) <= 0.005 &&
                                                  std::fabs(p.z - v.z * 0.3048) <= 0.005;
                                       });
        ASSERT_TRUE(found) << v.x << " " << v.y;
    }
    EXPECT_TRUE(core::build_tin(read->mesh));
}

TEST(GlbReader, TurnsTheAxesAndAppliesTransforms) {
    EXPECT_EQ(read_glb(changed([](json&) {}), {})->mesh.vertices, kSquare);
    // A parent moved, its child scaled by a matrix and mirrored: faces turn with it.
    const auto read =
        read_glb(changed([](json& d) {
                     d["scenes"][0]["nodes"] = {1};
                     d["nodes"][0]["matrix"] = {-2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
                     d["nodes"].push_back({{"children", {0}}, {"translation", {100, 7, -1000}}});
                 }),
                 {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices[0], (core::Point3{100, 1000, 9}));
    EXPECT_EQ(read->mesh.triangles, (Triangles{{0, 2, 1}, {0, 3, 2}}));
    EXPECT_TRUE(core::build_tin(read->mesh));
    // A quarter turn about the upright axis.
    const auto turned =
        read_glb(changed([](json& d) {
                     d["nodes"][0]["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
                 }),
                 {});
    EXPECT_NEAR(turned->mesh.vertices[1].x, 0, 1e-12);
    EXPECT_NEAR(turned->mesh.vertices[1].y, 4, 1e-12);
}

TEST(GlbReader, WeldsEqualPositionsOfAllPrimitives) {
    const auto read = read_glb(
        changed(
            [](json& d) {
                auto& primitives = d["meshes"][0]["primitives"];
                primitives.push_back(primitives[0]);
                primitives[0]["indices"] = 1;
                primitives[1].erase("indices");
                primitives[1]["attributes"]["POSITION"] = 2;
                d["accessors"][1]["count"] = 3;
                d["accessors"].push_back(
                    {{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
                d["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 36}});
                d["buffers"][0]["byteLength"] = 96;
            },
            square_bin() + bytes_of(std::vector<float>{0, 1, 0, 4, 3, -4, 0, 4, -4})),
        {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices, kSquare);
    EXPECT_EQ(read->mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(read->triangle_place(1), "triangle 0 of /meshes/0/primitives/1");
}

TEST(GlbReader, ReadsStripsAndFans) {
    const auto mode = [](int number) {
        return changed([number](json& d) {
            d["meshes"][0]["primitives"][0]["mode"] = number;
            d["meshes"][0]["primitives"][0].erase("indices");
        });
    };
    EXPECT_EQ(read_glb(mode(6), {})->mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(read_glb(mode(5), {})->mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(codes(mode(7)), "GLTF_INVALID/meshes/0/primitives/0/mode");
    EXPECT_EQ(codes(mode(1)), "GLTF_INVALID/scenes");  // passed over: nothing is left
}

TEST(GlbReader, ReadsQuantizedPositions) {
    const auto read =
        read_glb(changed(
                     [](json& d) {
                         d["extensionsRequired"] = {"KHR_mesh_quantization"};
                         d["accessors"][0]["componentType"] = 5122;
                         d["accessors"][0]["normalized"] = true;
                         d["bufferViews"][0]["byteStride"] = 8;
                         d["bufferViews"][0]["byteLength"] = 32;
                         d["bufferViews"][1]["byteOffset"] = 32;
                         d["buffers"][0]["byteLength"] = 44;
                         d["nodes"][0]["scale"] = {4, 4, 4};
                     },
                     bytes_of(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 32767, 0,
                                                        -32767, 0, 0, 0, -32768, 0}) +
                         square_bin().substr(48)),
                 {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices,
              (std::vector<core::Point3>{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}));
}

std::string packed_square() {
    const std::string bin = square_bin();
    std::string vertices(meshopt_encodeVertexBufferBound(4, 12), '\0');
    auto* to = reinterpret_cast<unsigned char*>(vertices.data());
    vertices.resize(meshopt_encodeVertexBuffer(to, vertices.size(), bin.data(), 4, 12));
    const std::vector<unsigned> indices{0, 1, 2, 0, 2, 3};
    std::string triangles(meshopt_encodeIndexBufferBound(6, 4), '\0');
    to = reinterpret_cast<unsigned char*>(triangles.data());
    triangles.resize(meshopt_encodeIndexBuffer(to, triangles.size(), indices.data(), 6));
    return changed(
        [&](json& d) {
            const auto packed = [](std::size_t offset, std::size_t length, int stride, int count,
                                   const char* mode) {
                return json{{"EXT_meshopt_compression",
                             {{"buffer", 0},
                              {"byteOffset", offset},
                              {"byteLength", length},
                              {"byteStride", stride},
                              {"count", count},
                              {"mode", mode}}}};
            };
            d["extensionsRequired"] = {"EXT_meshopt_compression"};
            d["bufferViews"][0]["extensions"] = packed(0, vertices.size(), 12, 4, "ATTRIBUTES");
            d["bufferViews"][1]["extensions"] =
                packed(vertices.size(), triangles.size(), 2, 6, "TRIANGLES");
            d["bufferViews"][0]["buffer"] = d["bufferViews"][1]["buffer"] = 1;
            d["buffers"][0]["byteLength"] = vertices.size() + triangles.size();
            d["buffers"].push_back({{"byteLength", 60}});
        },
        vertices + triangles);
}

TEST(GlbReader, ReadsWhatMeshoptimizerPacked) {
    const auto read = read_glb(packed_square(), {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices, kSquare);
    EXPECT_EQ(read->mesh.triangles.size(), 2U);
}

TEST(GlbReader, ReadsJsonWithDataAndRefusesOtherFilesByName) {
    json document = square_document();
    // 0 1 0, 4 2 0, 4 3 -4 and 0, 1, 2 as they lie in memory.
    document["accessors"][0]["count"] = document["accessors"][1]["count"] = 3;
    document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64,"
        "AAAAAAAAgD8AAAAAAACAQAAAAEAAAAAAAACAQAAAQEAAAIDAAAAAAAAAAAAAAAAAAAABAAIA";
    document["bufferViews"][1]["byteLength"] = 6;
    document["buffers"][0]["byteLength"] = 54;
    const auto read = read_glb(document.dump(), {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(read->mesh.vertices[2], kSquare[2]);
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64,AA*A";
    EXPECT_EQ(codes(document.dump()), "GLTF_INVALID/buffers/0/uri");
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAA";
    EXPECT_EQ(codes(document.dump()), "GLTF_INVALID/buffers/0/byteLength");
    document["buffers"][0]["uri"] = "https://example.org/terrain.bin";
    const auto refused = read_glb(document.dump(), {});
    EXPECT_EQ(refused.faults()[0].code, "GLTF_URI");
    EXPECT_NE(refused.faults()[0].detail.find("https://example.org/terrain.bin"),
              std::string::npos);
}

TEST(GlbReader, HoldsEverySpanAgainstTheBytes) {
    const auto with = [](const char* pointer, const json& value) {
        return codes(changed([&](json& d) { d[json::json_pointer(pointer)] = value; }));
    };
    EXPECT_EQ(with("/accessors/0/count", 5), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/count", 9e11), "TOO_MANY_VERTICES/accessors/0");
    EXPECT_EQ(with("/accessors/0/count", -1), "GLTF_INVALID/accessors/0/count");
    EXPECT_EQ(with("/accessors/0/byteOffset", 4), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/byteOffset", 1099511627776), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/componentType", 5125), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/componentType", 1), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/type", "VEC2"), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/bufferView", 9), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/accessors/0/sparse", json::object()), "GLTF_SPARSE/accessors/0");
    EXPECT_EQ(with("/accessors/1/componentType", 5126), "GLTF_INVALID/accessors/1");
    EXPECT_EQ(with("/bufferViews/0/byteStride", 8), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/bufferViews/0/byteStride", 16), "GLTF_INVALID/accessors/0");
    EXPECT_EQ(with("/bufferViews/1/byteLength", 13), "GLTF_INVALID/bufferViews/1");
    EXPECT_EQ(with("/buffers/0/byteLength", 61), "GLTF_INVALID/buffers/0/byteLength");
    EXPECT_EQ(with("/bufferViews/0/buffer", 1), "GLTF_INVALID/bufferViews/0");
    EXPECT_EQ(with("/nodes/0/mesh", 1), "GLTF_INVALID/nodes/0/mesh");
    EXPECT_EQ(with("/nodes/0/children", {0}), "GLTF_INVALID/nodes/0");
    EXPECT_EQ(with("/scenes/0/nodes", {7}), "GLTF_INVALID/nodes/7");
    EXPECT_EQ(with("/scene", 3), "GLTF_INVALID/scene");
    EXPECT_EQ(with("/extensionsRequired", {"EXT_x"}), "GLTF_EXTENSION/extensionsRequired/0");
    EXPECT_EQ(with("/asset/version", "1.0"), "GLTF_VERSION/asset/version");
    EXPECT_EQ(with("/meshes", 3), "GLTF_INVALID/meshes");
    EXPECT_EQ(with("/nodes/0/scale", {1, 2}), "GLTF_INVALID/nodes/0/scale");
    EXPECT_EQ(with("/nodes/0/translation", {1e300, 0, 0}).substr(0, 23), "COORDINATE_OUT_OF_RANGE");
    std::string bad_index = square_bin();
    bad_index[50] = 9;
    EXPECT_EQ(codes(changed([](json&) {}, bad_index)),
              "GLTF_INVALID/meshes/0/primitives/0/indices");
}

TEST(GlbReader, RefusesBrokenContainers) {
    const std::string good = changed([](json&) {});
    EXPECT_EQ(codes("glTF"), "GLB_SYNTAX");
    EXPECT_EQ(codes(good.substr(0, good.size() - 1)), "GLB_SYNTAX");
    std::string bytes = good;
    bytes[4] = 1;
    EXPECT_EQ(codes(bytes), "GLB_SYNTAX");
    bytes = good;
    bytes[15] = '\x7f';
    EXPECT_EQ(codes(bytes), "GLB_SYNTAX");
    bytes = good;
    bytes[20] = '[';
    EXPECT_EQ(codes(bytes), "GLTF_SYNTAX");
    EXPECT_EQ(codes("[]"), "GLTF_SYNTAX");
    EXPECT_EQ(codes(std::string(100'000, '[')), "GLTF_DOCUMENT");
    // In time that grows with the document: a list of so many objects took an hour once.
    std::string many = R"({"asset": {"version": "2.0"}, "nodes": [{})";
    for (int i = 0; i < 1'000'000; ++i)
        many += ",{}";
    EXPECT_EQ(codes(many + "]}"), "GLTF_DOCUMENT/nodes");
    many.resize(many.find("[{}") + 3 * (kMostGltfParts - 1));
    EXPECT_EQ(codes(many + ",{}]}"), "GLTF_INVALID/scenes");
    EXPECT_EQ(codes(R"({"asset": {"version": "2.0", "extras": {"a": 1, "\u0061": 2}}})"),
              "GLTF_INVALID");
    // What has no triangles in it may be as long as it likes.
    many = R"({"asset": {"version": "2.0"}, "extras": [0)";
    for (int i = 0; i < 1'000'000; ++i)
        many += ",0";
    EXPECT_EQ(codes(many + "]}"), "GLTF_INVALID/scenes");
    EXPECT_EQ(codes(R"({"nodes": [)" + std::string(5'000'000, '0').append("]}")), "GLTF_DOCUMENT");
}

TEST(GlbReader, HoldsWhatDracoPromisesAgainstTheBytes) {
    const core::MeshData mesh = terrain(0);
    const auto written = write_glb(mesh, {});
    std::string bytes = std::get<GltfResult>(written).bytes;
    const std::size_t at = bytes.find("DRACO");
    ASSERT_NE(at, bytes.npos);
    // After the head of 11 bytes and the kind of traversal: the numbers of vertices and faces.
    for (const std::size_t place : {at + 12, at + 14}) {
        std::string lying = bytes;
        lying.replace(place, 5, "\xff\xff\xff\xff\x0f");
        const auto read = read_glb(lying, {});
        ASSERT_FALSE(read);
        EXPECT_EQ(read.faults()[0].code, "GLTF_DRACO");
        EXPECT_EQ(read.kind(), FaultKind::TooLarge);
    }
    ReadLimits limits;
    limits.max_triangles = 100;
    EXPECT_EQ(codes(bytes, limits).substr(0, 10), "GLTF_DRACO");
    bytes[at + 5] = 1;  // another bitstream
    EXPECT_EQ(codes(bytes).substr(0, 10), "GLTF_DRACO");
    bytes[at] = 'X';
    EXPECT_EQ(codes(bytes).substr(0, 10), "GLTF_DRACO");
}

TEST(GlbReader, StopsAtItsLimits) {
    ReadLimits limits;
    limits.max_triangles = 1;
    EXPECT_EQ(codes(changed([](json&) {}), limits), "TOO_MANY_VERTICES/accessors/1");
    limits.max_triangles = 2;
    limits.max_vertices = 3;
    EXPECT_EQ(codes(changed([](json&) {}), limits), "TOO_MANY_VERTICES/meshes/0/primitives/0");
    limits = {};
    limits.progress = [](double) { return false; };
    EXPECT_EQ(codes(changed([](json&) {}), limits), "STOPPED");
}

}  // namespace
}  // namespace tinsmith::api
