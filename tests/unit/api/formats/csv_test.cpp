// SPDX-License-Identifier: Apache-2.0
#include "api/formats/csv.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/points_mesh.hpp"

namespace tinsmith::api {
namespace {

/// As the service does it: read, then triangulated.
Parsed<Terrain> read(std::string_view text, const ReadLimits& limits,
                     const TerrainOptions& options = {}) {
    auto terrain = read_csv(text, options, limits);
    if (!terrain) return terrain;
    EXPECT_TRUE(terrain->points && terrain->mesh.triangles.empty());
    return triangulated(*std::move(terrain), limits);
}

using Points = std::vector<core::Point3>;

const Points kSquare{{0, 0, 1}, {10, 0, 2.5}, {10, 10, -3}, {0, 10, 4}};

void expect_square(std::string_view text) {
    SCOPED_TRACE(std::string(text));
    const auto terrain = read(text, {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->mesh.vertices, kSquare);
    EXPECT_EQ(terrain->mesh.triangles.size(), 2U);
    EXPECT_TRUE(looks_like_csv(text));
}

TEST(Csv, ReadsFieldsPartedInEachWay) {
    expect_square("0,0,1\n10,0,2.5\n10,10,-3\n0,10,4\n");
    expect_square("0, 0 ,1\n10,0,2.5\n10,10,-3\n0,10,+4");
    expect_square("0;0;1\n1e1;0;2.5\n10;10;-3\n0;10;4\n");
    expect_square("0\t0\t1\n10\t0\t2.5\n10\t10\t-3\n0\t10\t4\n");
    expect_square("  0 0   1\n10 0 2.5 \n10   10 -3\n0\t10 4\n");
    expect_square("\"0\",\"0\",\"1\"\n10,0,2.5\n10,10,-3\n0,10,4\n");
}

TEST(Csv, PassesOverCommentsEmptyLinesAndTheMarkOfUtf8) {
    expect_square(
        "\xef\xbb\xbf# survey of May\r\n\r\n0,0,1\r\n  # more\r\n10,0,2.5\r\n10,10,-3\r\n"
        "0,10,4\r\n\r\n");
    expect_square("0,0,1\r10,0,2.5\r10,10,-3\r0,10,4");
}

TEST(Csv, TakesColumnsByTheNamesOfAHeader) {
    expect_square("x,y,z\n0,0,1\n10,0,2.5\n10,10,-3\n0,10,4\n");
    expect_square("Z;Y;X\n1;0;0\n2.5;0;10\n-3;10;10\n4;10;0\n");
    expect_square(
        "id,Northing (m),Easting (m),\"remark, if any\",Elevation [m]\n"
        "1,0,0,\"a \"\"good\"\" one, here\",1\n2,0,10,,2.5\n3,10,10,,-3\nlast,10,0,,4\n");
    expect_square("# E N H\nE N H\n0 0 1\n10 0 2.5\n10 10 -3\n0 10 4\n");
    // The header's own separator is that of the first line of data.
    expect_square("east\tnorth\theight, m\n0\t0\t1\n10\t0\t2.5\n10\t10\t-3\n0\t10\t4\n");
}

TEST(Csv, ReadsTheNearestDouble) {
    const auto terrain = read(
        "0.1,0.30000000000000004,1e-3\n123456789.123456789,0,2\n.5,5.,1.7976931348623157e0\n", {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->mesh.vertices[0], (core::Point3{0.1, 0.30000000000000004, 1e-3}));
    EXPECT_EQ(terrain->mesh.vertices[1].x, 123456789.123456789);
    EXPECT_EQ(terrain->mesh.vertices[2], (core::Point3{0.5, 5.0, 1.7976931348623157}));
}

TerrainOptions in_system(std::string crs, std::string project) {
    TerrainOptions options;
    options.crs = std::move(crs);
    options.project = std::move(project);
    return options;
}

TEST(Csv, TakesLongitudeAndLatitudeOfAGeographicSystemThatIsProjected) {
    for (const char* header : {"lon,lat,z", "Longitude (deg),Latitude (deg),Height (m)",
                               "lng,LAT,elevation", "long,latitude,alt"}) {
        const auto terrain = read_csv(std::string(header) + "\n2,48,100\n3,48,200\n2,49,300\n",
                                      in_system("EPSG:4326", "auto"), {});
        ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
        EXPECT_EQ(terrain->mesh.vertices, (Points{{2, 48, 100}, {3, 48, 200}, {2, 49, 300}}));
    }
    const auto swapped = read_csv("lat;z;lon\n48;100;2\n48;200;3\n49;300;2\n",
                                  in_system("EPSG:4326", "EPSG:2154"), {});
    ASSERT_TRUE(swapped.ok());
    EXPECT_EQ(swapped->mesh.vertices[1], (core::Point3{3, 48, 200}));
}

TEST(Csv, RefusesDegreesWithoutSystemOrPlanAndSaysWhatToAdd) {
    const auto hint = [](const char* header, const TerrainOptions& options) {
        const auto terrain = read_csv(std::string(header) + "\n1,2,3\n", options, {});
        if (terrain) return std::string("taken");
        EXPECT_EQ(terrain.kind(), FaultKind::Unsupported);
        EXPECT_EQ(terrain.faults().size(), 2U) << "one for each column";
        EXPECT_EQ(terrain.faults()[1].code, "CRS_GEOGRAPHIC");
        EXPECT_EQ(terrain.faults()[1].detail.substr(0, 18), "Line 1, column 5: ");
        return terrain.faults()[1].detail;
    };
    for (const TerrainOptions& options :
         {in_system("", ""), in_system("", "auto"), in_system("EPSG:32616", "auto")}) {
        const std::string detail = hint("lon,lat,z", options);
        EXPECT_NE(detail.find("crs=EPSG:4326"), std::string::npos) << detail;
        EXPECT_NE(detail.find("project=auto"), std::string::npos) << detail;
    }
    const std::string detail = hint("lon,lat,z", in_system("EPSG:4326", ""));
    EXPECT_NE(detail.find("add project=auto"), std::string::npos) << detail;
    EXPECT_EQ(detail.find("crs="), std::string::npos) << detail;
    const auto twice = read_csv("x,lat,lon,z\n1,2,3,4\n", in_system("EPSG:4326", "auto"), {});
    ASSERT_FALSE(twice.ok());
    EXPECT_EQ(twice.faults()[0].code, "COLUMN_REPEATED");
}

struct BadText {
    std::string text;
    std::string code;
    std::string beginning;  ///< of the detail
    FaultKind kind = FaultKind::Invalid;
};

TEST(Csv, NamesWhatIsWrongAndWhere) {
    const std::string end = "\n10,0,2\n0,10,3\n";
    const BadText cases[] = {
        {"0,a,1" + end, "NUMBER_INVALID", "Line 1, column 3: \"a\" is no number; "},
        {"0,,1" + end, "NUMBER_INVALID", "Line 1, column 3: The field is empty"},
        {"0,0x10,1" + end, "NUMBER_INVALID", "Line 1, column 3: "},
        {"0,inf,1" + end, "NUMBER_INVALID", "Line 1, column 3: "},
        {"0,-nan,1" + end, "NUMBER_INVALID", "Line 1, column 3: "},
        {"0,+-1,1" + end, "NUMBER_INVALID", "Line 1, column 3: "},
        {"0,1 2,1" + end, "NUMBER_INVALID", "Line 1, column 3: "},
        {"0,\xc3\xa4,1" + end, "NUMBER_INVALID", "Line 1, column 3: \"??\" is no number"},
        {"0,1e999,1" + end, "NUMBER_OUT_OF_RANGE", "Line 1, column 3: "},
        {"0,1e10,1" + end, "COORDINATE_OUT_OF_RANGE", "Line 1, column 3: "},
        {"0,0,1\n1,1" + end, "WRONG_LENGTH", "Line 2, column 3: 2 fields; without a header"},
        {"0,0,1,7" + end, "WRONG_LENGTH", "Line 1, column 7: 4 fields"},
        {"0,0,\"1" + end, "CSV_SYNTAX", "Line 1, column 5: A quote"},
        {"x,y,z\n0,0,1,7" + end, "WRONG_LENGTH", "Line 2, column 7: 4 fields; the header has 3."},
        {"0;0;1\n10,5;0;2\n0;10;3\n", "NUMBER_INVALID",
         "Line 2, column 1: \"10,5\" is no number: write decimals with a point"},
        {"0,5\t0\t1\n10\t0\t2\n0\t10\t3\n", "NUMBER_INVALID",
         "Line 1, column 1: \"0,5\" is no number: write decimals with a point"},
        {"a,b,c" + end, "COLUMN_MISSING", "Line 1, column 1: No column of the header is x; call"},
        {"x,y,height,easting,z\n" + end, "COLUMN_REPEATED", "Line 1, column 12: \"easting\""},
        {"lat,lon,z" + end, "CRS_GEOGRAPHIC", "Line 1, column 1: \"lat\" is in degrees",
         FaultKind::Unsupported},
        {"x,\"y,z" + end, "CSV_SYNTAX", "Line 1, column 3: A quote", FaultKind::Syntax},
        {"", "TOO_FEW_POINTS", "there are 0 distinct positions"},
        {"# nothing\n", "TOO_FEW_POINTS", "there are 0 distinct positions"},
        {"x,y,z\n", "TOO_FEW_POINTS", "there are 0 distinct positions"},
        {"0,0,0\n1,1,1\n2,2,2\n", "POINTS_COLLINEAR", "all points are on one line"},
        {"# one\n0,0,1\n\n0,0,2" + end, "ELEVATION_TWICE",
         "Line 4: point 1 is at the position of point 0 with another elevation; keep one of them "
         "(point 0 is in line 2)"},
        {std::string("0,0,1\n\0", 7) + end, "CSV_SYNTAX", "These bytes are no text",
         FaultKind::Syntax},
    };
    for (const BadText& bad : cases) {
        SCOPED_TRACE(bad.text);
        const auto terrain = read(bad.text, {});
        ASSERT_FALSE(terrain.ok());
        const Fault& fault = terrain.faults()[0];
        EXPECT_EQ(fault.code, bad.code);
        EXPECT_EQ(fault.detail.substr(0, bad.beginning.size()), bad.beginning);
        EXPECT_EQ(terrain.kind(), bad.kind);
    }
}

TEST(Csv, NamesAllFaultsUpToTheLimit) {
    const auto terrain = read("0,a,b\n10,0,2\nc,10,3\n1,2\n3,4,5\n", {});
    ASSERT_FALSE(terrain.ok());
    ASSERT_EQ(terrain.faults().size(), 4U);
    EXPECT_EQ(terrain.faults()[0].index, 0U);
    EXPECT_EQ(terrain.faults()[1].detail.substr(0, 18), "Line 1, column 5: ");
    EXPECT_EQ(terrain.faults()[2].index, 2U);
    EXPECT_EQ(terrain.faults()[3].index, 3U);
    std::string many;
    for (int i = 0; i < 1000; ++i)
        many += "a line,of,words\n7,8,b\n";
    EXPECT_EQ(read("1,2,3\n" + many, {}).faults().size(), kMaxFaults);
    ReadLimits limits;
    limits.max_faults = 3;
    EXPECT_EQ(read("1,2,3\n" + many, limits).faults().size(), 3U);
}

TEST(Csv, HoldsToItsLimits) {
    ReadLimits limits;
    limits.max_vertices = 4;
    const std::string four = "0,0,1\n10,0,2.5\n10,10,-3\n0,10,4\n";
    EXPECT_TRUE(read(four, limits).ok());
    const auto vertices = read(four + "5,5,5\n", limits);
    ASSERT_FALSE(vertices.ok());
    EXPECT_EQ(vertices.kind(), FaultKind::TooLarge);
    EXPECT_EQ(vertices.faults()[0].code, "TOO_MANY_VERTICES");
    limits.max_triangles = 1;
    EXPECT_EQ(read(four, limits).faults()[0].code, "TOO_MANY_TRIANGLES");
    // A line of a million separators makes no million fields.
    const auto wide = read(std::string(1'000'000, ','), {});
    ASSERT_FALSE(wide.ok());
    EXPECT_EQ(wide.faults()[0].code, "TOO_MANY_COLUMNS");
    EXPECT_EQ(read("1" + std::string(1'000'000, ','), {}).faults()[0].code, "WRONG_LENGTH");
}

TEST(Csv, TellsItsProgressAndStops) {
    std::string text;
    for (int i = 0; i < 50'000; ++i)
        text += std::to_string(i % 250) + "," + std::to_string(i / 250) + ",1\n";
    std::vector<double> told;
    ReadLimits limits;
    limits.progress = [&](double share) {
        told.push_back(share);
        return true;
    };
    ASSERT_TRUE(read(text, limits).ok());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(told.size(), 12U);
    for (const std::size_t stop : {std::size_t{3}, told.size() - 2}) {
        std::size_t asked = 0;
        limits.progress = [&](double) { return asked++ != stop; };
        const auto stopped = read(text, limits);
        ASSERT_FALSE(stopped.ok());
        EXPECT_EQ(stopped.kind(), FaultKind::Stopped);
        EXPECT_EQ(asked, stop + 1);
    }
}

TEST(Csv, IsKnownByItsFirstLine) {
    for (const char* text :
         {"1 2 3", "# a\n\n-1.5;2;3", "x,y,z", "id\tnorthing\teasting\th", "lon,lat,z\n"})
        EXPECT_TRUE(looks_like_csv(text)) << text;
    for (const char* text :
         {"", "{\"mesh\": 1}", "[1,2,3]", "v 1 2 3\n", "# obj\nv 1 2 3", "ncols 4\nnrows 5", "<x/>",
          "glTF", "1 2", "1-2 3 4", "12 monkeys", "# only"})
        EXPECT_FALSE(looks_like_csv(text)) << text;
}

}  // namespace
}  // namespace tinsmith::api
