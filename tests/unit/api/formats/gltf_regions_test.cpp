// SPDX-License-Identifier: Apache-2.0
// Regions as primitives, with Draco, meshopt and none; what decoders see of their borders.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "api/formats/gltf.hpp"
#include "api/formats/gltf_features.hpp"
#include "tests/unit/api/formats/gltf_decoding.hpp"
#include "tests/unit/api/formats/gltf_matching.hpp"

namespace tinsmith::api {
namespace {

using nlohmann::json;
using testing::DecodedGlb;
using testing::DecodedPrimitive;
using testing::expect_same_lines;
using testing::expect_same_mesh;
using testing::hills;

constexpr std::array kCompressions{Compression::Draco, Compression::Meshopt, Compression::None};

/// The hills of 20 x 20 cells with p1 in their lower left quarter, p2 in a strip across it.
RegionPartition quarters(const core::MeshData& mesh) {
    RegionPartition regions;
    regions.unit = "metre";
    regions.features = {
        {"p1", "\"north\"", R"({"use": "meadow", "floors": 2, "deep": {"a": 1}})", 10.5, 11.5},
        {"p2", "", R"({"name": "Strip", "floors": 2.5, "use": 7})", 20.5, 21.5}};
    regions.sets = {{}, {0}, {1}, {0, 1}};
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t column = t / 2 % 20, row = t / 2 / 20;
        const bool first = column < 10 && row < 10, second = row >= 5 && row < 8;
        regions.set_of.push_back((first ? 1U : 0U) + (second ? 2U : 0U));
    }
    return regions;
}

GltfResult written(const core::MeshData& mesh, const GltfOptions& options,
                   const RegionPartition* regions) {
    auto result = write_glb(mesh, options, regions);
    if (const auto* error = std::get_if<EncodeError>(&result)) {
        ADD_FAILURE() << error->detail;
        return {};
    }
    return std::get<GltfResult>(std::move(result));
}

/// The bits of a position: -0 and 0 are two.
std::array<std::uint32_t, 3> bits_of(const std::array<float, 3>& p) {
    return {std::bit_cast<std::uint32_t>(p[0]), std::bit_cast<std::uint32_t>(p[1]),
            std::bit_cast<std::uint32_t>(p[2])};
}

TEST(GltfRegions, HoldTheMeshEachSetInAPrimitive) {
    const core::MeshData mesh = hills(20, 20, 30);
    const RegionPartition regions = quarters(mesh);
    for (const Compression compression : kCompressions) {
        GltfOptions options;
        options.compression = compression;
        const GltfResult result = written(mesh, options, &regions);
        const DecodedGlb glb = testing::decode_glb(result.bytes);
        expect_same_mesh(mesh, options, glb);
        expect_same_lines(mesh, options, glb);
        ASSERT_EQ(glb.primitives.size(), 5U) << "ground, three sets and the lines";
        EXPECT_EQ(result.primitives, 4U);
        std::map<json, std::size_t> triangles;
        for (const DecodedPrimitive& primitive : glb.primitives) {
            if (primitive.mode != 4) continue;
            triangles[primitive.json.at("extras").at("polygons")] += primitive.indices.size() / 3;
        }
        EXPECT_EQ(triangles[json::array()], 800U - 200U - 120U + 60U);
        EXPECT_EQ(triangles[json::array({"p1"})], 140U);
        EXPECT_EQ(triangles[json::array({"p2"})], 60U);
        EXPECT_EQ(triangles[json::array({"p1", "p2"})], 60U);
    }
}

TEST(GltfRegions, BordersDecodeToTheSameBits) {
    // With cells of 6 km Draco cuts its primitives into tiles, too.
    for (const auto& [cell, up] :
         {std::pair(30.0, UpAxis::Y), {30.0, UpAxis::Z}, {6000.0, UpAxis::Y}}) {
        const core::MeshData mesh = hills(20, 20, cell);
        const RegionPartition regions = quarters(mesh);
        for (const Compression compression : kCompressions) {
            GltfOptions options;
            options.compression = compression;
            options.up = up;
            const DecodedGlb glb = testing::decode_glb(written(mesh, options, &regions).bytes);
            // Vertices of the mesh by the decoded bits that stand for them: one each, though those
            // on a border are in several primitives.
            std::set<std::array<std::uint32_t, 3>> places;
            std::size_t vertices = 0;
            for (const DecodedPrimitive& primitive : glb.primitives) {
                EXPECT_EQ(primitive.translation, glb.primitives[0].translation);
                if (primitive.mode != 4) continue;
                vertices += primitive.positions.size();
                for (const auto& p : primitive.positions)
                    places.insert(bits_of(p));
            }
            EXPECT_EQ(places.size(), mesh.vertices.size());
            EXPECT_GT(vertices, mesh.vertices.size());
        }
    }
}

TEST(GltfRegions, NameTheNewestPolygonFirst) {
    const core::MeshData mesh = hills(20, 20, 30);
    const RegionPartition regions = quarters(mesh);
    for (const Compression compression : kCompressions) {
        GltfOptions options;
        options.compression = compression;
        const DecodedGlb glb = testing::decode_glb(written(mesh, options, &regions).bytes);
        const std::map<json, std::vector<std::uint16_t>> expected{
            {json::array(), {2}},
            {json::array({"p1"}), {0}},
            {json::array({"p2"}), {1}},
            {json::array({"p1", "p2"}), {1, 0}}};
        for (const DecodedPrimitive& primitive : glb.primitives) {
            if (primitive.mode != 4) {
                EXPECT_TRUE(primitive.features.empty());
                continue;
            }
            const auto& ids = expected.at(primitive.json.at("extras").at("polygons"));
            ASSERT_EQ(primitive.features.size(), ids.size());
            const auto& sets =
                primitive.json.at("extensions").at("EXT_mesh_features").at("featureIds");
            ASSERT_EQ(sets.size(), ids.size());
            for (std::size_t i = 0; i < ids.size(); ++i) {
                EXPECT_EQ(primitive.features[i].size(), primitive.positions.size());
                EXPECT_TRUE(std::ranges::all_of(primitive.features[i],
                                                [&](std::uint16_t id) { return id == ids[i]; }));
                EXPECT_EQ(sets[i].at("attribute"), i);
                EXPECT_EQ(sets[i].at("propertyTable"), 0);
                EXPECT_EQ(sets[i].contains("nullFeatureId"), ids[i] == 2);
            }
        }
        EXPECT_EQ(glb.json.at("scenes")[0].at("extras").at("regions")[0],
                  json::parse(R"({"id": "p1", "name": "north", "plan_area": 10.5,
                                  "surface_area": 11.5, "properties":
                                  {"use": "meadow", "floors": 2, "deep": {"a": 1}}})"));
    }
}

/// The rows of a column as the file has them.
json rows_of(const DecodedGlb& glb, std::string_view bin, const std::string& column) {
    const auto& extension = glb.json.at("extensions").at("EXT_structural_metadata");
    const auto& table = extension.at("propertyTables")[0];
    const auto& kind =
        extension.at("schema").at("classes").at("region").at("properties").at(column);
    const auto& place = table.at("properties").at(column);
    const auto bytes = [&](const json& view) {
        const auto& described = glb.json.at("bufferViews")[view.get<std::size_t>()];
        EXPECT_EQ(described.at("byteOffset").get<std::size_t>() % 8, 0U);
        return bin.substr(described.at("byteOffset").get<std::size_t>(),
                          described.at("byteLength").get<std::size_t>());
    };
    json rows = json::array();
    const std::string_view values = bytes(place.at("values"));
    for (std::size_t row = 0; row < table.at("count").get<std::size_t>(); ++row) {
        if (kind.at("type") == "STRING") {
            const std::string_view offsets = bytes(place.at("stringOffsets"));
            const std::size_t from = testing::word(offsets, 4 * row);
            rows.push_back(values.substr(from, testing::word(offsets, 4 * row + 4) - from));
        } else {
            double number = 0.0;
            std::memcpy(&number, values.data() + 8 * row, 8);
            rows.push_back(number);
        }
        if (kind.contains("noData") && kind.at("noData") == rows.back()) rows.back() = nullptr;
    }
    return rows;
}

TEST(GltfRegions, HaveATableOfTheirProperties) {
    const core::MeshData mesh = hills(20, 20, 30);
    RegionPartition regions = quarters(mesh);
    const std::string bytes = written(mesh, {}, &regions).bytes;
    const DecodedGlb glb = testing::decode_glb(bytes);
    const std::string_view bin = std::string_view(bytes).substr(28 + testing::word(bytes, 12));
    EXPECT_EQ(rows_of(glb, bin, "id"), json({"p1", "p2"}));
    EXPECT_EQ(rows_of(glb, bin, "name"), json({"north", "Strip"}));
    EXPECT_EQ(rows_of(glb, bin, "plan_area"), json({10.5, 20.5}));
    EXPECT_EQ(rows_of(glb, bin, "surface_area"), json({11.5, 21.5}));
    EXPECT_EQ(rows_of(glb, bin, "floors"), json({2.0, 2.5}));
    EXPECT_EQ(rows_of(glb, bin, "use"), json({"meadow", "7"})) << "mixed: texts";
    const auto& columns = glb.json.at("extensions")
                              .at("EXT_structural_metadata")
                              .at("propertyTables")[0]
                              .at("properties");
    EXPECT_FALSE(columns.contains("deep")) << "not a scalar";
    EXPECT_EQ(glb.json.at("extensionsUsed"),
              json({"EXT_mesh_features", "EXT_structural_metadata", "KHR_draco_mesh_compression"}));
    EXPECT_EQ(glb.json.at("extensionsRequired"), json({"KHR_draco_mesh_compression"}));
}

TEST(GltfRegions, ColumnsHaveSoundTypesAndNames) {
    RegionPartition regions;
    regions.features = {
        {"p1", "7", R"({"a b": 1, "a_b": "x", "1": true, "id": "mine", "big": 9007199254740993})",
         0, 0},
        {"p2", "", R"({"a b": null, "a_b": "", "id": [1], "": 5})", 0, 0},
        {"p3", "", R"({"a b": -1.7976931348623157e308})", 0, 0}};
    const PropertyTable table = property_table(regions);
    std::map<std::string, const PropertyColumn*> by_id;
    for (const PropertyColumn& column : table.columns)
        EXPECT_TRUE(by_id.emplace(column.id, &column).second) << column.id;
    EXPECT_EQ(table.columns.size(), 10U);
    ASSERT_TRUE(by_id.contains("a_b") && by_id.contains("a_b_2") && by_id.contains("_1") &&
                by_id.contains("id_2") && by_id.contains("big") && by_id.contains("_"));
    EXPECT_EQ(by_id["name"]->values, "7p2p3");
    const PropertyColumn& numbers = *by_id["a_b"];
    EXPECT_EQ(numbers.name, "a b");
    EXPECT_FALSE(numbers.is_text);
    ASSERT_TRUE(numbers.no_number);
    EXPECT_NE(*numbers.no_number, std::numeric_limits<double>::lowest()) << "a value of p3";
    const PropertyColumn& texts = *by_id["a_b_2"];
    ASSERT_TRUE(texts.is_text && texts.no_text);
    EXPECT_NE(*texts.no_text, "") << "a value of p2";
    EXPECT_EQ(texts.values, "x" + *texts.no_text);
    EXPECT_EQ(texts.offsets, (std::vector<std::uint32_t>{0, 1, 1, 5}));
    EXPECT_TRUE(by_id["_1"]->is_text);
    EXPECT_EQ(by_id["_1"]->values, "true");
    EXPECT_TRUE(by_id["big"]->is_text) << "no double holds it";
    EXPECT_EQ(by_id["big"]->values, "9007199254740993");
}

TEST(GltfRegions, FindAValueForNoneWhateverTheValues) {
    RegionPartition regions;
    std::string text = "null";
    double number = std::numeric_limits<double>::lowest();
    char properties[600];
    for (int i = 0; i < 2200; ++i, number /= 2.0) {  // down to nought, with each on the way
        std::snprintf(properties, sizeof properties, R"({"v": %.17e, "t": "null %d"})", number, i);
        regions.features.push_back({"p" + std::to_string(i), "", properties, 0, 0});
    }
    regions.features.push_back({"p0", "", R"({"v": 0, "t": "null"})", 0, 0});
    regions.features.push_back({"p1", "", R"({"t": ""})", 0, 0});
    regions.features.push_back({"p2", "", R"({"v": 1})", 0, 0});
    const PropertyTable table = property_table(regions);
    for (const PropertyColumn& column : table.columns) {
        if (column.name == "v") {
            ASSERT_TRUE(column.no_number);
            for (std::size_t row = 0; row + 2 < table.rows; ++row) {
                double value = 0.0;
                std::memcpy(&value, column.values.data() + row * sizeof value, sizeof value);
                EXPECT_NE(value, *column.no_number) << row;
            }
        }
        if (column.name == "t") {
            EXPECT_EQ(column.no_text, "null 2200");
        }
    }
}

TEST(GltfRegions, AreBoundedInColumns) {
    std::string properties = "{";
    for (int i = 0; i < 500; ++i)
        properties += (i > 0 ? ",\"k" : "\"k") + std::to_string(i) + "\":1";
    RegionPartition regions;
    regions.features = {{"p1", "", properties + "}", 0, 0}};
    EXPECT_EQ(property_table(regions).columns.size(), 4 + kMostOwnColumns);
    EXPECT_EQ(json::parse(regions_extras(regions))[0].at("properties").size(), 500U);
}

TEST(GltfRegions, WithoutPolygonsThereIsOnePrimitive) {
    const core::MeshData mesh = hills(5, 5, 30);
    RegionPartition none;
    none.set_of.resize(mesh.triangles.size());
    const DecodedGlb glb = testing::decode_glb(written(mesh, {}, &none).bytes);
    expect_same_mesh(mesh, {}, glb);
    EXPECT_FALSE(glb.json.contains("extensions"));
    EXPECT_EQ(glb.json.at("scenes")[0].at("extras").at("regions"), json::array());
}

TEST(GltfMeshopt, HoldsTheMeshOnTheGridOfDraco) {
    const core::MeshData mesh = hills(60, 40, 30);
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        std::vector<std::set<std::array<std::uint32_t, 3>>> places;
        for (const Compression compression : {Compression::Draco, Compression::Meshopt}) {
            GltfOptions options;
            options.compression = compression;
            options.up = up;
            const GltfResult result = written(mesh, options, nullptr);
            const DecodedGlb glb = testing::decode_glb(result.bytes);
            expect_same_mesh(mesh, options, glb);
            expect_same_lines(mesh, options, glb);
            auto& seen = places.emplace_back();
            for (const auto& p : glb.primitives[0].positions)
                seen.insert(bits_of(p));
        }
        EXPECT_EQ(places[0], places[1]) << "bit for bit";
    }
}

TEST(GltfMeshopt, SaysWhatItNeeds) {
    const core::MeshData mesh = hills(10, 10, 30);
    const GltfResult result = written(mesh, {.compression = Compression::Meshopt}, nullptr);
    EXPECT_EQ(result.bits, 0U);
    const DecodedGlb glb = testing::decode_glb(result.bytes);
    EXPECT_EQ(glb.json.at("extensionsRequired"), json({"EXT_meshopt_compression"}));
    EXPECT_EQ(glb.json.at("extensionsUsed"), json({"EXT_meshopt_compression"}));
    ASSERT_EQ(glb.json.at("buffers").size(), 2U);
    EXPECT_FALSE(glb.json.at("buffers")[1].contains("uri"));
    EXPECT_EQ(result.bytes, written(mesh, {.compression = Compression::Meshopt}, nullptr).bytes);
}

TEST(GltfMeshopt, HoldsWhatIsWiderThanItsFilterAndThanANode) {
    for (const double cell : {4000.0, 20000.0}) {
        const core::MeshData mesh = hills(40, 2, cell);
        GltfOptions options{.compression = Compression::Meshopt, .tolerance = 0.005};
        const GltfResult result = written(mesh, options, nullptr);
        const DecodedGlb glb = testing::decode_glb(result.bytes);
        EXPECT_EQ(result.nodes, cell > 10000 ? 8U : 1U) << "four of triangles, four of lines";
        expect_same_mesh(mesh, options, glb);
        expect_same_lines(mesh, options, glb);
    }
}

TEST(GltfJson, HoldsTheSameAsTheBinary) {
    const core::MeshData mesh = hills(8, 8, 30);
    for (const Compression compression : kCompressions) {
        GltfOptions options;
        options.compression = compression;
        const std::string glb = written(mesh, options, nullptr).bytes;
        const auto made = write_gltf(mesh, options);
        const auto* result = std::get_if<GltfResult>(&made);
        ASSERT_NE(result, nullptr);
        json document = json::parse(result->bytes);
        const std::string uri = document.at("buffers")[0].at("uri");
        constexpr std::string_view kHead = "data:application/octet-stream;base64,";
        ASSERT_TRUE(uri.starts_with(kHead));
        // Decoded here by the book.
        std::string bytes;
        std::uint32_t bits = 0;
        unsigned held = 0;
        for (const char c : std::string_view(uri).substr(kHead.size())) {
            if (c == '=') break;
            const auto digit =
                std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
                    .find(c);
            ASSERT_NE(digit, std::string_view::npos);
            bits = bits << 6 | static_cast<std::uint32_t>(digit);
            held += 6;
            if (held < 8) continue;
            held -= 8;
            bytes.push_back(static_cast<char>(bits >> held & 0xFF));
        }
        EXPECT_EQ(bytes.size(), document.at("buffers")[0].at("byteLength"));
        EXPECT_EQ(glb.substr(28 + testing::word(glb, 12), bytes.size()), bytes);
        document.at("buffers")[0].erase("uri");
        EXPECT_EQ(document, testing::decode_glb(glb).json);
    }
}

}  // namespace
}  // namespace tinsmith::api
