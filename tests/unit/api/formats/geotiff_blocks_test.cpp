// SPDX-License-Identifier: Apache-2.0
// How pixels and masks lie in a GeoTIFF.
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "tests/unit/api/formats/tiff_bytes.hpp"

namespace tinsmith::api {
namespace {

using testing::TiffBytes;

Parsed<Terrain> read_mesh(const std::string& bytes) {
    return meshed(read_geotiff(bytes, {}, {}), {});
}

TiffBytes three_by_two() {
    return TiffBytes(3, 2, {1.5F, 2, 3, 4, 5, 6.25F}).place(500000, 4000000, 10, 10);
}

void expect_damaged(const std::string& bytes) {
    const auto terrain = read_mesh(bytes);
    ASSERT_FALSE(terrain.ok());
    EXPECT_EQ(terrain.faults().at(0).code, "TIFF_DAMAGED") << terrain.faults()[0].detail;
}

constexpr std::uint16_t kDeflate = 8;

/// A zlib stream of one block that is stored as it is.
std::string stored(const std::string& data) {
    std::string packed(compressBound(static_cast<uLong>(data.size())), '\0');
    auto size = static_cast<uLongf>(packed.size());
    EXPECT_EQ(compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                        reinterpret_cast<const Bytef*>(data.data()),
                        static_cast<uLong>(data.size()), Z_NO_COMPRESSION),
              Z_OK);
    packed.resize(size);
    return packed;
}

/// The file with a second directory: the mask of its pixels, a byte of bits for each row, or those
/// deflated.
std::string masked(std::string bytes, std::uint32_t width, const std::string& rows,
                   std::uint32_t height = 0) {
    const auto number = [](std::uint32_t value, std::size_t size) {
        return std::string(reinterpret_cast<const char*>(&value), size);  // little-endian
    };
    const std::size_t next = bytes.size() - 4;
    const auto at = static_cast<std::uint32_t>(bytes.size());
    bytes += rows + std::string(rows.size() % 2, '\0');
    bytes.replace(next, 4, number(static_cast<std::uint32_t>(bytes.size()), 4));
    const auto size = static_cast<std::uint32_t>(rows.size());
    const std::uint32_t compression = height == 0 ? 1 : kDeflate;
    if (height == 0) height = size;
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> tags{
        {254, 4},  // a mask
        {256, width}, {257, height}, {258, 1},      {259, compression}, {262, 4},
        {273, at},    {277, 1},      {278, height}, {279, size}};
    bytes += number(static_cast<std::uint32_t>(tags.size()), 2);
    for (const auto& [tag, value] : tags)
        bytes += number(tag, 2) + number(4, 2) + number(1, 4) + number(value, 4);
    return bytes + std::string(4, '\0');
}

TEST(GeoTiffBlocks, WhatAMaskHidesIsNoData) {
    const std::string bytes = three_by_two().bytes();
    const auto all = read_mesh(masked(bytes, 3, "\xe0\xe0"));
    ASSERT_TRUE(all.ok()) << all.faults()[0].detail;
    EXPECT_EQ(all->mesh.triangles.size(), 4U);
    const auto some = read_mesh(masked(bytes, 3, "\xc0\xe0"));
    ASSERT_TRUE(some.ok()) << some.faults()[0].detail;
    EXPECT_EQ(some->mesh.vertices.size(), 5U) << "without the last of the first row";
    EXPECT_EQ(some->mesh.triangles.size(), 3U);
}

/// What a block does not hold must not come from what the process had in its memory.
TEST(GeoTiffBlocks, DeflatedBlocksHoldExactlyTheirPixels) {
    const std::vector<float> pixels{1.5F, 2, 3, 4, 5, 6.25F};
    std::string data(pixels.size() * sizeof(float), '\0');
    std::memcpy(data.data(), pixels.data(), data.size());
    const auto file = [](const std::string& strip) {
        return three_by_two().coded(kDeflate, strip).bytes();
    };
    const auto whole = read_mesh(file(stored(data)));
    ASSERT_TRUE(whole.ok()) << whole.faults()[0].detail;
    EXPECT_EQ(whole->mesh.vertices[0].z, 1.5);
    EXPECT_EQ(whole->mesh.vertices[5].z, 6.25);
    const std::string junk(16, 'x');
    EXPECT_TRUE(read_mesh(file(stored(data) + junk)).ok()) << "what follows is nobody's";
    for (const std::string& other :
         {data + '\0', data + std::string(60'000, 'x'), data.substr(1), std::string()}) {
        SCOPED_TRACE(other.size());
        expect_damaged(file(stored(other)));
    }
    expect_damaged(file(stored(data).substr(0, 20)));
    std::string wrong_sum = stored(data);
    wrong_sum.back() ^= 1;
    expect_damaged(file(wrong_sum));

    const std::string bytes = three_by_two().bytes();
    const auto some = read_mesh(masked(bytes, 3, stored("\xc0\xe0"), 2));
    ASSERT_TRUE(some.ok()) << some.faults()[0].detail;
    EXPECT_EQ(some->mesh.vertices.size(), 5U);
    expect_damaged(masked(bytes, 3, stored(std::string(60'000, 'x')), 2));
    expect_damaged(masked(bytes, 3, stored("\xc0\xe0\xe0"), 2));
}

}  // namespace
}  // namespace tinsmith::api
