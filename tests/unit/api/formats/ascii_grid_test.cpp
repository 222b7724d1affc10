// SPDX-License-Identifier: Apache-2.0
#include "api/formats/ascii_grid.hpp"

#include <array>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "api/formats/grid_mesh.hpp"

namespace tinsmith::api {
namespace {

using core::Point3;

const std::string kHeader = "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\n";

Terrain read(const std::string& text, const TerrainOptions& options = {}) {
    auto terrain = meshed(read_ascii_grid(text, options, {}), {});
    if (terrain) return *std::move(terrain);
    ADD_FAILURE() << terrain.faults()[0].code << ": " << terrain.faults()[0].detail;
    return {};
}

std::string refused(const std::string& text, const ReadLimits& limits = {},
                    const TerrainOptions& options = {}) {
    const auto terrain = meshed(read_ascii_grid(text, options, limits), limits);
    if (terrain) return "taken";
    std::string all;
    for (const Fault& fault : terrain.faults())
        all += fault.code + ": " + fault.detail + "\n";
    return all;
}

bool tells(const std::string& all, const std::string& part) {
    return all.find(part) != std::string::npos;
}

TEST(AsciiGrid, PostsLieAtTheCentresOfCells) {
    const Terrain terrain = read(kHeader + "1 2 3\n4 5 6.25\n");
    ASSERT_EQ(terrain.mesh.vertices.size(), 6U);
    EXPECT_EQ(terrain.mesh.vertices[0], (Point3{500005, 4000015, 1})) << "the northern row first";
    EXPECT_EQ(terrain.mesh.vertices[5], (Point3{500025, 4000005, 6.25}));
    EXPECT_EQ(terrain.mesh.triangles.size(), 4U);
    EXPECT_EQ(terrain.crs, "");
    EXPECT_EQ(terrain.unit, "metre");
}

TEST(AsciiGrid, CentresAndTwoSizesAndAnyCase) {
    const Terrain terrain = read(
        "  NROWS 2 NCOLS +2\r\nXLLCENTER 100\r\nyllCenter\t200\r\nDX 10\r\nDY 20\r\n"
        "nodata_VALUE -1e4\r\n1 2 3\r\n4");
    ASSERT_EQ(terrain.mesh.vertices.size(), 4U);
    EXPECT_EQ(terrain.mesh.vertices[0], (Point3{100, 220, 1}));
    EXPECT_EQ(terrain.mesh.vertices[3], (Point3{110, 200, 4}));
}

TEST(AsciiGrid, NoDataIsAHole) {
    const Terrain terrain = read(kHeader + "NODATA_value -9999\n1 2 -9999.0\n4 5 6\n");
    EXPECT_EQ(terrain.mesh.vertices.size(), 5U);
    EXPECT_EQ(terrain.mesh.triangles.size(), 3U);
    EXPECT_EQ(read(kHeader + "nan 2 3\n4 5 6\n").mesh.vertices.size(), 5U);
    EXPECT_EQ(read(kHeader + "NODATA_value nan\n1 2 nan\n4 5 6\n").mesh.vertices.size(), 5U);
}

TEST(AsciiGrid, EveryDigitCounts) {
    const Terrain terrain = read(kHeader + "123.4567890123 16777217 0.1\n-0 1e-3 6\n");
    EXPECT_EQ(terrain.mesh.vertices[0].z, 123.4567890123);
    EXPECT_EQ(terrain.mesh.vertices[1].z, 16777217.0) << "as a float it would be one less";
}

TEST(AsciiGrid, TheOptionsNameItsSystem) {
    TerrainOptions options;
    options.crs = "EPSG:2264";
    const Terrain feet = read(kHeader + "1 2 3 4 5 6", options);
    EXPECT_EQ(feet.crs, "EPSG:2264");
    EXPECT_EQ(feet.unit, "US survey foot");
    options.crs = "EPSG:4326";
    EXPECT_TRUE(tells(refused(kHeader + "1 2 3 4 5 6", {}, options), "CRS_GEOGRAPHIC"));
}

TEST(AsciiGrid, DegreesAreWarped) {
    TerrainOptions options;
    options.crs = "EPSG:4326";
    options.project = "auto";
    const std::string plane =
        "ncols 4\nnrows 4\nxllcenter 9\nyllcenter 47\ncellsize 0.001\n"
        "103 103 103 103\n102 102 102 102\n101 101 101 101\n100 100 100 100\n";
    const Terrain terrain = read(plane, options);
    EXPECT_EQ(terrain.crs, "EPSG:32632");
    ASSERT_GT(terrain.mesh.vertices.size(), 6U);
    int inside = 0;
    for (const Point3& p : terrain.mesh.vertices) {
        EXPECT_NEAR(p.x, 500000, 300);
        if (p.z < 100.001 || p.z > 102.999) continue;  // in the half cell beyond the outer posts
        ++inside;
        // A metre of height for each row; rows are 111.13 metres apart by cs2cs of PROJ 9.1.1.
        EXPECT_NEAR(p.z, 100 + (p.y - 5205164.11) / 111.127, 0.01) << p.x << " " << p.y;
    }
    EXPECT_GE(inside, 4);
}

TEST(AsciiGrid, HeadersAreRefusedWordByWord) {
    EXPECT_TRUE(tells(refused("ncols 3\nnrows 2\n1 2 3 4 5 6"), "no xllcorner or xllcenter"));
    EXPECT_TRUE(tells(refused("ncols 3\nnrows 2\n1 2 3 4 5 6"), "no cellsize"));
    EXPECT_TRUE(tells(refused("ncols 3\nncols 3\n"), "At line 2, column 1: ncols stands here"));
    EXPECT_TRUE(tells(refused("ncols three\n"), "At line 1, column 7: ncols needs a number"));
    EXPECT_TRUE(tells(refused("ncols 3\nrows 2\n"), "\"rows\" is no word of the header"));
    EXPECT_TRUE(tells(refused(kHeader + "xllcenter 5\n1 2 3 4 5 6"), "or it has both"));
    EXPECT_TRUE(tells(refused("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1"),
                      "ncols is a whole number"));
    EXPECT_TRUE(tells(refused("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1"),
                      "cellsize is a length above 0"));
    EXPECT_TRUE(tells(refused("ncols 2\nnrows 2\nxllcorner nan\nyllcorner 0\ncellsize 1\n1 2 3 4"),
                      "xllcorner is beyond 1e9"));
    EXPECT_TRUE(tells(refused(""), "no ncols"));
}

TEST(AsciiGrid, ElevationsAreRefusedByLineAndColumn) {
    const std::string all = refused(kHeader + "1 2,5 3\n4 five 1e99\n");
    EXPECT_TRUE(tells(all, "GRID_NUMBER: At line 6, column 3: \"2,5\" is no number. The decimal"));
    EXPECT_TRUE(tells(all, "GRID_NUMBER: At line 7, column 3: \"five\""));
    EXPECT_TRUE(tells(all, "COORDINATE_OUT_OF_RANGE: At line 7, column 8"));
    EXPECT_TRUE(tells(refused(kHeader + "1 2 3\n4.00 5.00\n"),
                      "GRID_TOO_SHORT: At line 8, column 1: the file ends after 5 of 6"));
    EXPECT_TRUE(
        tells(refused(kHeader + "1 2 3\n4 5 6\n7\n"), "GRID_TOO_LONG: At line 8, column 1"));
    const auto terrain = read_ascii_grid(kHeader + "1 2 3\n4 x 6\n", {}, {});
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.kind(), FaultKind::Syntax);
    EXPECT_EQ(terrain.faults()[0].index, 4U);
    EXPECT_EQ(terrain.faults()[0].coordinate, (std::array{500015.0, 4000005.0}));
}

TEST(AsciiGrid, SizesAreCheckedBeforeMemoryIsTaken) {
    const std::string huge =
        "ncols 60000\nnrows 60000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3";
    EXPECT_TRUE(tells(refused(huge), "TOO_MANY_VERTICES"));
    ReadLimits boundless;
    boundless.max_vertices = std::size_t{1} << 40;
    EXPECT_TRUE(tells(refused(huge, boundless), "GRID_TOO_SHORT"));
    ReadLimits few;
    few.max_faults = 3;
    std::string bad = "ncols 100\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n5 ";
    for (int i = 0; i < 200; ++i)
        bad += "x ";
    const auto terrain = read_ascii_grid(bad, {}, few);
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.faults().size(), 3U);
}

TEST(AsciiGrid, CanBeStopped) {
    ReadLimits limits;
    limits.progress = [](double) { return false; };
    const auto terrain = read_ascii_grid(kHeader + "1 2 3 4 5 6", {}, limits);
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.kind(), FaultKind::Stopped);
}

TEST(AsciiGrid, IsKnownByItsFirstWord) {
    for (const char* yes : {"ncols 3", "  NROWS\t2", "\r\nxllcorner 0"})
        EXPECT_TRUE(begins_as_ascii_grid(yes)) << yes;
    for (const char* no : {"", "{\"mesh\": 1}", "x,y,z", "ncolsx 3", "II*"})
        EXPECT_FALSE(begins_as_ascii_grid(no)) << no;
}

}  // namespace
}  // namespace tinsmith::api
