// SPDX-License-Identifier: Apache-2.0
#include "api/formats/draco_encoder.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/api/formats/gltf_decoding.hpp"

namespace tinsmith::api {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

testing::DecodedPrimitive decode(const DracoBytes& bytes) {
    testing::DecodedPrimitive to;
    nlohmann::json attributes{{"POSITION", bytes.position_id}};
    if (bytes.normal_id) attributes["NORMAL"] = *bytes.normal_id;
    testing::decode_draco({{"attributes", attributes}}, bytes.bytes, to);
    return to;
}

/// A strip whose x goes up to kDracoSteps from `low`, odd and even steps at both ends.
std::vector<GridPoint> strip(std::int32_t low) {
    std::vector<GridPoint> points;
    for (std::int32_t i = 0; i < 200; ++i) {
        points.push_back({low + i, i % 2, -i});
        points.push_back({low + kDracoSteps - 400 + i, i % 3, i});
    }
    points.push_back({low + kDracoSteps, 0, 0});
    std::sort(points.begin(), points.end());
    return points;
}

std::vector<Triangle> strip_triangles(std::size_t points) {
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i + 2 < points; ++i)
        triangles.push_back(i % 2 ? Triangle{i + 1, i, i + 2} : Triangle{i, i + 1, i + 2});
    return triangles;
}

TEST(DracoEncoder, DecodesToTheGridBitForBit) {
    for (const std::int32_t low : {0, -kFloatSteps, kFloatSteps - kDracoSteps, -4194304, 12345}) {
        for (const int exponent : {-20, -7, 0, 30}) {
            const auto points = strip(low);
            const auto triangles = strip_triangles(points.size());
            const auto result = encode_draco({points, {}, triangles, exponent});
            ASSERT_TRUE(std::holds_alternative<DracoBytes>(result));
            const auto& bytes = std::get<DracoBytes>(result);
            EXPECT_EQ(bytes.position_bits, kDracoBits);
            EXPECT_EQ(bytes.points, points.size());
            EXPECT_EQ(bytes.triangles, triangles.size());
            EXPECT_FALSE(bytes.normal_id);
            std::vector<std::array<float, 3>> expected;
            for (const GridPoint& p : points) {
                expected.push_back({std::ldexp(static_cast<float>(p[0]), exponent),
                                    std::ldexp(static_cast<float>(p[1]), exponent),
                                    std::ldexp(static_cast<float>(p[2]), exponent)});
            }
            auto decoded = decode(bytes).positions;
            std::sort(decoded.begin(), decoded.end());
            std::sort(expected.begin(), expected.end());
            EXPECT_EQ(decoded, expected);
        }
    }
}

TEST(DracoEncoder, TellsTheDecodedCountWhereFansTouch) {
    // Two fans that share vertex 2 only: Draco makes two points of it.
    const std::vector<GridPoint> points{{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {0, 4, 0}, {4, 4, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {2, 4, 3}};
    const std::vector<std::array<float, 3>> normals(points.size(), {0, 0, 1});
    const auto result = encode_draco({points, normals, triangles, 0});
    ASSERT_TRUE(std::holds_alternative<DracoBytes>(result));
    const auto decoded = decode(std::get<DracoBytes>(result));
    EXPECT_EQ(std::get<DracoBytes>(result).points, decoded.positions.size());
    EXPECT_EQ(decoded.indices.size(), 6u);
    ASSERT_EQ(decoded.normals.size(), decoded.positions.size());
    EXPECT_NEAR(decoded.normals.front()[2], 1.0, 1e-3);
}

TEST(DracoEncoder, KeepsCollapsedTriangles) {
    const std::vector<GridPoint> points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}};
    const auto result = encode_draco({points, {}, std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}, 0});
    ASSERT_TRUE(std::holds_alternative<DracoBytes>(result));
    EXPECT_EQ(std::get<DracoBytes>(result).triangles, 2u);
    EXPECT_EQ(decode(std::get<DracoBytes>(result)).indices.size(), 6u);
}

TEST(DracoEncoder, RefusesAPieceTooWide) {
    const std::vector<GridPoint> points{{0, 0, 0}, {kDracoSteps + 1, 0, 0}, {0, 1, 0}};
    const auto result = encode_draco({points, {}, std::vector<Triangle>{{0, 1, 2}}, 0});
    ASSERT_TRUE(std::holds_alternative<EncodeError>(result));
    EXPECT_EQ(std::get<EncodeError>(result).fault, EncodeFault::Codec);
}

TEST(DracoEncoder, GivesTheSameBytesAgain) {
    const auto points = strip(5);
    const auto triangles = strip_triangles(points.size());
    const auto first = encode_draco({points, {}, triangles, -7});
    const auto second = encode_draco({points, {}, triangles, -7});
    EXPECT_EQ(std::get<DracoBytes>(first).bytes, std::get<DracoBytes>(second).bytes);
}

}  // namespace
}  // namespace tinsmith::api
