// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geotiff.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/grid_mesh.hpp"
#include "tests/unit/api/formats/tiff_bytes.hpp"

#if defined(__SANITIZE_THREAD__)
// GDAL takes two of its locks in both orders while it registers a driver: always in one thread,
// within our call_once, so that no other can hold the second one meanwhile.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
    return "deadlock:libgdal.so\n";
}
#endif

namespace tinsmith::api {
namespace {

using core::Point3;
using testing::TiffBytes;

/// As the server reads it that has to mend it, for the triangles.
Parsed<Terrain> read_mesh(std::string_view bytes, const ReadLimits& limits,
                          const TerrainOptions& options = {}) {
    return meshed(read_geotiff(bytes, limits, options), limits);
}

TiffBytes three_by_two() {
    return TiffBytes(3, 2, {1.5F, 2, 3, 4, 5, 6.25F}).place(500000, 4000000, 10, 10);
}

void expect_fault(const std::string& bytes, FaultKind kind, const std::string& code,
                  const ReadLimits& limits = {}) {
    ::testing::internal::CaptureStderr();
    const auto terrain = read_mesh(bytes, limits);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    ASSERT_FALSE(terrain.ok()) << "expected " << code;
    EXPECT_EQ(terrain.kind(), kind);
    EXPECT_EQ(terrain.faults().at(0).code, code) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain.faults()[0].detail.find("vsimem"), std::string::npos)
        << terrain.faults()[0].detail;
}

TEST(GeoTiff, PostsLieAtPixelCentres) {
    const auto terrain = read_mesh(three_by_two().projected(32616).bytes(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->crs, "EPSG:32616");
    EXPECT_EQ(terrain->unit, "metre");
    ASSERT_EQ(terrain->mesh.vertices.size(), 6U);
    EXPECT_EQ(terrain->mesh.triangles.size(), 4U);
    EXPECT_EQ(terrain->mesh.vertices[0], (Point3{500005, 3999995, 1.5}));
    EXPECT_EQ(terrain->mesh.vertices[5], (Point3{500025, 3999985, 6.25}));
}

TEST(GeoTiff, PixelIsPointNamesTheCentreItself) {
    TiffBytes tiff(2, 2, {1, 2, 3, 4});
    const auto terrain =
        read_mesh(tiff.place(500000, 4000000, 10, 10, true).projected(32616).bytes(), {});
    ASSERT_TRUE(terrain.ok());
    EXPECT_EQ(terrain->mesh.vertices[0], (Point3{500000, 4000000, 1}));
    EXPECT_EQ(terrain->mesh.vertices[3], (Point3{500010, 3999990, 4}));
}

TEST(GeoTiff, WithoutReferenceSystemTheNameIsEmpty) {
    const auto terrain = read_mesh(three_by_two().bytes(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->crs, "");
    EXPECT_EQ(terrain->unit, "metre");
}

TEST(GeoTiff, FeetAreNamed) {
    const auto terrain = read_mesh(three_by_two().projected(2264).bytes(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->unit, "US survey foot");
    EXPECT_EQ(terrain->crs, "EPSG:2264");
}

const std::string kFootBand =
    R"(<GDALMetadata><Item name="UNITTYPE" sample="0" role="unittype">ft</Item></GDALMetadata>)";

TEST(GeoTiff, ElevationsOfAnotherUnitBecomeOnesOfThePlans) {
    const auto terrain = read_mesh(three_by_two().vertical(6360).bytes(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->unit, "metre");
    EXPECT_NEAR(terrain->mesh.vertices[5].z, 6.25 * 1200 / 3937, 1e-14);
    const auto band =
        read_mesh(three_by_two().projected(32616).set_text(42112, kFootBand).bytes(), {});
    ASSERT_TRUE(band.ok()) << band.faults()[0].detail;
    EXPECT_NEAR(band->mesh.vertices[5].z, 6.25 * 0.3048, 1e-15);
    // A plan without a system is in the unit of the elevations.
    const auto alone = read_mesh(three_by_two().set_text(42112, kFootBand).bytes(), {});
    ASSERT_TRUE(alone.ok()) << alone.faults()[0].detail;
    EXPECT_EQ(alone->unit, "foot");
    EXPECT_EQ(alone->mesh.vertices[5].z, 6.25);
}

TEST(GeoTiff, OptionsNameWhatTheFileDoesNot) {
    TerrainOptions options;
    options.crs = "EPSG:2264";
    const auto named = read_mesh(three_by_two().bytes(), {}, options);
    ASSERT_TRUE(named.ok()) << named.faults()[0].detail;
    EXPECT_EQ(named->crs, "EPSG:2264");
    EXPECT_EQ(named->unit, "US survey foot");
    const auto other = read_mesh(three_by_two().projected(32616).bytes(), {}, options);
    ASSERT_FALSE(other.ok());
    EXPECT_EQ(other.faults()[0].code, "CONTRADICTION");
    EXPECT_EQ(other.faults()[0].parameter, "crs");
}

TEST(GeoTiff, DegreesAreWarpedWhereProjectSaysSo) {
    TiffBytes tiff(4, 4, {1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4});
    tiff.place(-84.1, 36.4, 0.001, 0.001).geographic(4326).set_text(42112, kFootBand);
    TerrainOptions options;
    options.project = "auto";
    const auto zone = read_mesh(tiff.bytes(), {}, options);
    ASSERT_TRUE(zone.ok()) << zone.faults()[0].detail;
    EXPECT_EQ(zone->crs, "EPSG:32616");
    EXPECT_TRUE(zone->settled);
    for (const auto& p : zone->mesh.vertices) {
        EXPECT_GE(p.z, 0.3048 - 1e-9) << "feet have become metres";
        EXPECT_LE(p.z, 4 * 0.3048 + 1e-9);
    }
    options.project = "EPSG:2274";
    const auto feet = read_mesh(tiff.bytes(), {}, options);
    ASSERT_TRUE(feet.ok()) << feet.faults()[0].detail;
    EXPECT_EQ(feet->unit, "US survey foot");
    options.project = "EPSG:999999";
    EXPECT_EQ(read_mesh(tiff.bytes(), {}, options).faults().at(0).code, "CRS_UNKNOWN");
    options.project = "EPSG:31370";  // Belgium
    EXPECT_EQ(read_mesh(tiff.bytes(), {}, options).faults().at(0).code, "CRS_OUT_OF_AREA");
    options.project = "auto";
    const auto polar = read_mesh(tiff.place(10, 88, 0.001, 0.001).bytes(), {}, options);
    ASSERT_FALSE(polar.ok());
    EXPECT_EQ(polar.faults()[0].code, "PROJECT_POLAR");
    ReadLimits few;
    few.max_vertices = 16;
    options.project = "EPSG:3413";  // north is not up there
    const auto many = read_mesh(tiff.place(10, 70, 0.001, 0.001).bytes(), few, options);
    ASSERT_FALSE(many.ok());
    EXPECT_EQ(many.faults()[0].code, "TOO_MANY_VERTICES");
}

TEST(GeoTiff, UnitsOfElevationsThatAreNoneAreRefused) {
    std::string odd = kFootBand;
    odd.replace(odd.find(">ft<"), 4, ">kelvin<");
    expect_fault(three_by_two().projected(32616).set_text(42112, odd).bytes(),
                 FaultKind::Unsupported, "UNIT_UNKNOWN");
}

TEST(GeoTiff, NoDataIsAHole) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    TiffBytes tiff(3, 2, {1, 2, nan, 4, 5, -9999.9F});
    const auto terrain =
        read_mesh(tiff.place(0, 20, 10, 10).set_text(42113, "-9999.9").bytes(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->mesh.vertices.size(), 4U);
    EXPECT_EQ(terrain->mesh.triangles.size(), 2U);
}

TEST(GeoTiff, ScaleAndOffsetAreApplied) {
    const auto terrain = read_mesh(
        three_by_two()
            .set_text(42112,
                      "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item>"
                      "<Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item></GDALMetadata>")
            .bytes(),
        {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->mesh.vertices[0].z, 100.75);
}

TEST(GeoTiff, WhatIsNotTakenIsNamed) {
    constexpr auto unsupported = FaultKind::Unsupported;
    expect_fault(three_by_two().geographic(4326).bytes(), unsupported, "CRS_GEOGRAPHIC");
    expect_fault(TiffBytes(2, 2, {1, 2, 3, 4}).bytes(), FaultKind::Invalid,
                 "TIFF_NOT_GEOREFERENCED");
    expect_fault(TiffBytes(2, 2, {1, 2, 3, 4})
                     .transformation({8, 6, 0, 100, 6, -8, 0, 200, 0, 0, 1, 0, 0, 0, 0, 1})
                     .bytes(),
                 unsupported, "TIFF_ROTATED");
    expect_fault(TiffBytes(1, 1, {1, 2}).set_short(277, 2).set_shorts(258, {32, 32}).bytes(),
                 unsupported, "TIFF_BANDS");
    expect_fault(TiffBytes(1, 2, {1, 2}).place(0, 0, 1, 1).bytes(), FaultKind::Invalid,
                 "GRID_TOO_SMALL");
    expect_fault(TiffBytes(1, 1, {1, 2}).set_short(258, 64).set_short(339, 6).bytes(), unsupported,
                 "TIFF_DATA_TYPE");
    expect_fault(TiffBytes(1, 1, {1, 2}).set_short(258, 64).set_short(339, 2).bytes(), unsupported,
                 "TIFF_DATA_TYPE");
}

TEST(GeoTiff, UndeclaredNoDataIsToldWithItsPlace) {
    TiffBytes tiff(2, 2, {1, 2, -3.4e38F, 4});
    const auto terrain = read_mesh(tiff.place(0, 20, 10, 10).bytes(), {});
    ASSERT_FALSE(terrain.ok());
    EXPECT_EQ(terrain.faults()[0].code, "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(terrain.faults()[0].coordinate, (std::array<double, 2>{5, 5}));
    EXPECT_EQ(terrain.faults()[0].index, 2U);
}

TEST(GeoTiff, LyingHeaders) {
    constexpr auto invalid = FaultKind::Invalid;
    // Sizes that the file does not hold.
    expect_fault(three_by_two().set_long(256, 2'000'000'000).set_long(257, 2'000'000'000).bytes(),
                 FaultKind::TooLarge, "TOO_MANY_VERTICES");
    expect_fault(three_by_two().set_long(256, 3000).set_long(257, 3000).bytes(), invalid,
                 "TIFF_BLOCK_MISSING");
    expect_fault(three_by_two().set_long(256, 3000).set_long(257, 3000).set_long(278, 3000).bytes(),
                 invalid, "TIFF_DAMAGED");
    // A strip beyond the end, and one that is said not to be there.
    expect_fault(three_by_two().set_long(273, 1'000'000).bytes(), invalid, "TIFF_DAMAGED");
    expect_fault(three_by_two().set_long(273, 0).set_long(279, 0).bytes(), invalid,
                 "TIFF_BLOCK_MISSING");
    // A codec the bytes are not in.
    expect_fault(three_by_two().set_short(259, 8).bytes(), invalid, "TIFF_DAMAGED");
    // Tiles that are far larger than the raster.
    expect_fault(three_by_two()
                     .set_long(322, 65536)
                     .set_long(323, 65536)
                     .set_long(324, 8)
                     .set_long(325, 24)
                     .bytes(),
                 FaultKind::TooLarge, "TIFF_BLOCK_SIZE");
}

TEST(GeoTiff, TruncatedAnywhere) {
    const std::string whole = three_by_two().projected(32616).bytes();
    ASSERT_TRUE(read_mesh(whole, {}).ok());
    for (std::size_t length = 0; length + 4 < whole.size(); ++length) {
        ::testing::internal::CaptureStderr();
        const auto terrain = read_mesh(std::string_view(whole).substr(0, length), {});
        EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
        ASSERT_FALSE(terrain.ok()) << length;
    }
}

/// PROJ has no unit of that code, and told so on stderr, where only the log belongs.
TEST(GeoTiff, AUnitThatProjDoesNotKnowIsNoLineOnStderr) {
    std::ifstream in(TINSMITH_SOURCE_DIR "/tests/fuzz/corpus/geotiff/unit_unknown_to_proj.tif",
                     std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    ASSERT_FALSE(bytes.empty());
    ::testing::internal::CaptureStderr();
    const auto terrain = read_mesh(bytes, {});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    ASSERT_FALSE(terrain.ok());
    EXPECT_EQ(terrain.faults()[0].code, "COORDINATE_OUT_OF_RANGE");
}

TEST(GeoTiff, AnyByteChangedIsATerrainOrAFault) {
    const std::string whole = three_by_two().projected(32616).bytes();
    ReadLimits limits;
    limits.max_vertices = 100'000;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const char value : {'\0', '\1', '\x7f', '\xff'}) {
            std::string bytes = whole;
            bytes[at] = value;
            const auto terrain = read_mesh(bytes, limits);
            if (!terrain.ok()) {
                EXPECT_FALSE(terrain.faults().empty());
            }
        }
    }
}

TEST(GeoTiff, OtherFormatsAreNotOpened) {
    constexpr auto syntax = FaultKind::Syntax;
    expect_fault("", syntax, "TIFF_SYNTAX");
    expect_fault("no TIFF at all", syntax, "TIFF_SYNTAX");
    expect_fault(
        "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand band=\"1\" "
        "dataType=\"Byte\"><SimpleSource><SourceFilename>/etc/passwd</SourceFilename>"
        "</SimpleSource></VRTRasterBand></VRTDataset>",
        syntax, "TIFF_SYNTAX");
    expect_fault("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n", syntax,
                 "TIFF_SYNTAX");
}

TEST(GeoTiff, Limits) {
    ReadLimits limits;
    limits.max_vertices = 5;
    expect_fault(three_by_two().bytes(), FaultKind::TooLarge, "TOO_MANY_VERTICES", limits);
    limits = {};
    limits.max_triangles = 3;
    expect_fault(three_by_two().bytes(), FaultKind::TooLarge, "TOO_MANY_TRIANGLES", limits);
}

TEST(GeoTiff, SeveralThreadsAtOnce) {
    const std::string bytes = three_by_two().projected(32616).bytes();
    std::vector<std::jthread> threads;
    std::vector<int> good(4, 0);
    for (std::size_t i = 0; i < good.size(); ++i) {
        threads.emplace_back([&, i] {
            for (int round = 0; round < 20; ++round)
                good[i] += read_mesh(bytes, {}).ok();
        });
    }
    threads.clear();
    EXPECT_EQ(good, std::vector<int>(4, 20));
}

TEST(GeoTiff, TheBundledTerrain) {
    const std::filesystem::path path =
        std::filesystem::path(TINSMITH_SOURCE_DIR) / "tests/data/jacksboro.tif";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no bundled terrain";
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    const auto terrain = read_mesh(bytes.str(), {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->unit, "metre");
    EXPECT_NE(terrain->crs, "");
    EXPECT_GT(terrain->mesh.triangles.size(), terrain->mesh.vertices.size());
}

}  // namespace
}  // namespace tinsmith::api
