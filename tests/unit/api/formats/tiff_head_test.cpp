// SPDX-License-Identifier: Apache-2.0
#include "api/formats/tiff_head.hpp"

#include <string>

#include <gtest/gtest.h>

#include "api/formats/geotiff.hpp"
#include "tests/unit/api/formats/tiff_bytes.hpp"

namespace tinsmith::api {
namespace {

using testing::TiffBytes;

/// A TIFF of a directory alone, in big-endian bytes: entries of tag, type and value.
std::string big_endian(const std::string& entries, char count) {
    return std::string("MM\0\x2A\0\0\0\x08\0", 9) + count + entries;
}

TEST(TiffHead, CountsBands) {
    TiffBytes tiff(2, 2, {1, 2, 3, 4});
    EXPECT_EQ(tiff_band_count(tiff.bytes()), 1U);
    tiff.set_short(277, 46'774);
    EXPECT_EQ(tiff_band_count(tiff.bytes()), 46'774U);
    tiff.set_long(277, 70'000);
    EXPECT_EQ(tiff_band_count(tiff.bytes()), 70'000U);
}

TEST(TiffHead, ReadsBothByteOrdersAndBigTiff) {
    const std::string entry("\x01\x15\0\x03\0\0\0\x01\x12\x34\0\0", 12);
    EXPECT_EQ(tiff_band_count(big_endian(entry, 1)), 0x1234U);
    EXPECT_EQ(tiff_band_count(
                  big_endian(entry + std::string("\x01\x15\0\x04\0\0\0\x01\0\x01\0\0", 12), 2)),
              0x10000U)
        << "the most";
    const std::string big = std::string("II\x2B\0\x08\0\0\0\x10\0\0\0\0\0\0\0", 16) +
                            std::string("\x01\0\0\0\0\0\0\0", 8) +
                            std::string("\x15\x01\x10\0\x01\0\0\0\0\0\0\0\x05\0\0\0\0\0\0\0", 20);
    EXPECT_EQ(tiff_band_count(big), 5U);
}

TEST(TiffHead, MindsItsBytes) {
    for (const std::string& bytes :
         {std::string(), std::string("II"), std::string("II*\0", 4),
          std::string("II*\0\xFF\xFF\xFF\xFF", 8),
          std::string("MM\0+\0\x08\0\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 16), big_endian("", 5),
          big_endian("\x01\x15", 1)})
        EXPECT_EQ(tiff_band_count(bytes), 0U);
    std::string whole = TiffBytes(2, 2, {1, 2, 3, 4}).bytes();
    for (; !whole.empty(); whole.pop_back())
        EXPECT_LE(tiff_band_count(whole), 1U);
}

TEST(TiffHead, KeepsManyBandsFromBeingOpened) {
    TiffBytes tiff(2, 2, {1, 2, 3, 4});
    tiff.set_short(277, 46'774);
    const auto parsed = read_geotiff(tiff.bytes(), {}, {});
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.faults()[0].code, "TIFF_BANDS");
    EXPECT_NE(parsed.faults()[0].detail.find("46774"), std::string::npos);
}

}  // namespace
}  // namespace tinsmith::api
