// SPDX-License-Identifier: Apache-2.0
#include "api/formats/terrain_json.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/points_mesh.hpp"

namespace tinsmith::api {
namespace {

/// As the service does it: read, then triangulated where it is points.
Parsed<Terrain> read(std::string_view body, const ReadLimits& limits) {
    auto terrain = read_terrain_json(body, limits);
    if (!terrain) return terrain;
    EXPECT_FALSE(terrain->points && !terrain->mesh.triangles.empty());
    return triangulated(*std::move(terrain), limits);
}

TEST(TerrainJson, ReadsAMeshWithMembersInAnyOrder) {
    const auto terrain = read_terrain_json(
        R"({"mesh": {"triangles": [[0, 1, 2], [2, 1, 3.0]],
                     "vertices": [[0, 0, 1], [10, 0, 2.5], [0, 10, -3e0], [10, 10, 4]]},
            "crs": "urn:ogc:def:crs:EPSG::32616", "unit": "meter", "name": "Jacksboro"})",
        {});
    ASSERT_TRUE(terrain.ok());
    EXPECT_EQ(terrain->name, "Jacksboro");
    EXPECT_EQ(terrain->crs, "EPSG:32616");
    EXPECT_EQ(terrain->unit, "metre");
    ASSERT_EQ(terrain->mesh.vertices.size(), 4U);
    EXPECT_EQ(terrain->mesh.vertices[2], (core::Point3{0, 10, -3}));
    ASSERT_EQ(terrain->mesh.triangles.size(), 2U);
    EXPECT_EQ(terrain->mesh.triangles[1], (std::array<std::uint32_t, 3>{2, 1, 3}));
}

TEST(TerrainJson, LeavesPointsToBeTriangulated) {
    const std::string body =
        R"({"points": [[0,0,1],[10,0,2],[10,10,3],[0,0,1],[0,10,4]], "crs": "EPSG:32616"})";
    const auto terrain = read(body, {});
    ASSERT_TRUE(terrain.ok()) << terrain.faults()[0].detail;
    EXPECT_EQ(terrain->crs, "EPSG:32616");
    EXPECT_EQ(terrain->mesh.vertices,
              (std::vector<core::Point3>{{0, 0, 1}, {10, 0, 2}, {10, 10, 3}, {0, 10, 4}}));
    EXPECT_EQ(terrain->mesh.triangles.size(), 2U);
    ReadLimits limits;
    limits.max_vertices = 4;
    EXPECT_EQ(read(body, limits).faults()[0].code, "TOO_MANY_VERTICES");
    limits.max_vertices = 5;
    limits.max_triangles = 1;
    EXPECT_EQ(read(body, limits).faults()[0].code, "TOO_MANY_TRIANGLES");
}

TEST(TerrainJson, TellsOfPointsInTwoHalvesAndStopsInEach) {
    std::string body = R"({"points": [)";
    for (int i = 0; i < 40'000; ++i)
        body +=
            (i > 0 ? ",[" : "[") + std::to_string(i % 200) + "," + std::to_string(i / 200) + ",1]";
    body += "]}";
    std::vector<double> told;
    ReadLimits limits;
    limits.progress = [&](double share) {
        told.push_back(share);
        return true;
    };
    ASSERT_TRUE(read(body, limits).ok());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(told.size(), 8U);
    for (const std::size_t stop : {std::size_t{2}, told.size() - 1}) {
        std::size_t asked = 0;
        limits.progress = [&](double) { return asked++ != stop; };
        const auto stopped = read(body, limits);
        ASSERT_FALSE(stopped.ok());
        EXPECT_EQ(stopped.kind(), FaultKind::Stopped);
        EXPECT_EQ(asked, stop + 1);
    }
}

TEST(TerrainJson, ReadsAGridFromNorthToSouthWithAHole) {
    const auto terrain = read_terrain_json(
        R"({"grid": {"elevations": [1, 2, null, 4, 5, 6, 7, 8, 9], "columns": 3, "rows": 3,
                     "origin": [100, 200], "cell": [10, -10]}, "unit": "US survey foot"})",
        {});
    ASSERT_TRUE(terrain.ok());
    EXPECT_EQ(terrain->unit, "US survey foot");
    EXPECT_EQ(terrain->mesh.vertices.size(), 8U);
    EXPECT_EQ(terrain->mesh.triangles.size(), 7U);
    EXPECT_EQ(terrain->mesh.vertices[0], (core::Point3{100, 200, 1}));
    EXPECT_EQ(terrain->mesh.vertices[7], (core::Point3{120, 180, 9}));
}

struct BadBody {
    std::string body;
    FaultKind kind;
    std::string code;
    std::string pointer;
};

std::string grid(std::string_view members) {
    return R"({"grid": {)" + std::string(members) + "}}";
}

TEST(TerrainJson, NamesWhatIsWrongAndWhere) {
    constexpr auto invalid = FaultKind::Invalid;
    const std::string vertices = R"("vertices": [[0,0,0],[1,0,0],[0,1,0]])";
    const auto mesh = [&](const std::string& triangles) {
        return R"({"mesh": {)" + vertices + R"(, "triangles": )" + triangles + "}}";
    };
    const auto vertex = [](const std::string& text) {
        return R"({"mesh": {"triangles": [[0,1,2]], "vertices": [[0,0,0],)" + text + "]}}";
    };
    const std::string place = R"("origin": [0,0], "cell": [1,1], )";
    const BadBody cases[] = {
        {"{}", invalid, "MEMBER_MISSING", ""},
        {R"({"points": [[0,0,0]]})", invalid, "TOO_FEW_POINTS", "/points"},
        {R"({"points": [[0,0,0],[1,1,0],[2,2,0]]})", invalid, "POINTS_COLLINEAR", "/points"},
        {R"({"points": [[0,0,0],[1,1,0],[2,0,0],[1,1,7]]})", invalid, "ELEVATION_TWICE",
         "/points/3"},
        {R"({"points": {}})", invalid, "WRONG_TYPE", "/points"},
        {R"({"points": [[0,0,0],[1,1]]})", invalid, "WRONG_LENGTH", "/points/1"},
        {R"({"points": [[0,0,0],[1,1,1e10]]})", invalid, "COORDINATE_OUT_OF_RANGE", "/points/1/2"},
        {R"({"mesh": {"vertices": []}})", invalid, "MEMBER_MISSING", "/mesh"},
        {R"({"mesh": []})", invalid, "WRONG_TYPE", "/mesh"},
        {mesh("{}"), invalid, "WRONG_TYPE", "/mesh/triangles"},
        {mesh("[[0,1,-2]]"), invalid, "INDEX_INVALID", "/mesh/triangles/0/2"},
        {mesh("[[0,1,2],[0,1.5,2]]"), invalid, "INDEX_INVALID", "/mesh/triangles/1/1"},
        {mesh("[[0,1,4294967295]]"), invalid, "INDEX_INVALID", "/mesh/triangles/0/2"},
        {mesh("[[0,1,null]]"), invalid, "WRONG_TYPE", "/mesh/triangles/0/2"},
        {mesh("[[0,1]]"), invalid, "WRONG_LENGTH", "/mesh/triangles/0"},
        {mesh("[[0,1,2,0]]"), invalid, "WRONG_LENGTH", "/mesh/triangles/0"},
        {R"({"mesh": {"vertices": [], "triangles": [4]}})", invalid, "WRONG_TYPE",
         "/mesh/triangles/0"},
        {vertex("[1,2]"), invalid, "WRONG_LENGTH", "/mesh/vertices/1"},
        {vertex("[1,2,1e10]"), invalid, "COORDINATE_OUT_OF_RANGE", "/mesh/vertices/1/2"},
        {vertex("[1,-2e9,1]"), invalid, "COORDINATE_OUT_OF_RANGE", "/mesh/vertices/1/1"},
        {vertex("[1e-70,2,1]"), invalid, "COORDINATE_OUT_OF_RANGE", "/mesh/vertices/1/0"},
        {vertex("[1,2,1e400]"), invalid, "NUMBER_OUT_OF_RANGE", "/mesh/vertices/1/2"},
        {vertex("[1,\"2\",1]"), invalid, "WRONG_TYPE", "/mesh/vertices/1/1"},
        {vertex("[1,[2],1]"), invalid, "WRONG_TYPE", "/mesh/vertices/1/1"},
        {vertex("[1,2,NaN]"), FaultKind::Syntax, "JSON_SYNTAX", ""},
        {grid(place + R"("columns": 2, "rows": 2, "elevations": [1,2,3])"), invalid, "WRONG_LENGTH",
         "/grid/elevations"},
        {grid(place + R"("columns": 1, "rows": 2, "elevations": [1,2])"), invalid,
         "NUMBER_OUT_OF_RANGE", "/grid/columns"},
        {grid(place + R"("columns": 4294967295, "rows": 4294967295, "elevations": [1,2])"),
         FaultKind::TooLarge, "TOO_MANY_VERTICES", "/grid"},
        {grid(place + R"("columns": 2, "rows": 2, "elevations": [1,2,3,"4"])"), invalid,
         "WRONG_TYPE", "/grid/elevations/3"},
        {grid(place + R"("columns": 2, "rows": 2, "elevations": [1,2,3,4], "step": 1)"), invalid,
         "MEMBER_UNKNOWN", "/grid/step"},
        {grid(R"("origin": [0], "cell": [1,1], "columns": 2, "rows": 2, "elevations": [1,2,3,4])"),
         invalid, "WRONG_LENGTH", "/grid/origin"},
        {grid(
             R"("origin": [0,0], "cell": [0,1], "columns": 2, "rows": 2, "elevations": [1,2,3,4])"),
         invalid, "COORDINATE_OUT_OF_RANGE", "/grid"},
        {grid(place + R"("columns": 2, "rows": 2, "elevations": [1,null,null,4])"), invalid,
         "MESH_EMPTY", "/grid"},
    };
    for (const BadBody& bad : cases) {
        SCOPED_TRACE(bad.body);
        const auto terrain = read(bad.body, {});
        ASSERT_FALSE(terrain.ok());
        EXPECT_EQ(terrain.kind(), bad.kind);
        ASSERT_EQ(terrain.faults().size(), 1U) << terrain.faults()[1].code;
        EXPECT_EQ(terrain.faults()[0].code, bad.code) << terrain.faults()[0].detail;
        EXPECT_EQ(terrain.faults()[0].pointer, bad.pointer);
    }
}

TEST(TerrainJson, NamesWhatIsWrongAroundAGoodMesh) {
    const std::string mesh =
        R"("mesh": {"vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]})";
    const BadBody cases[] = {
        {R"("crs": "the usual one")", FaultKind::Invalid, "CRS_UNKNOWN", "/crs"},
        {R"("unit": "cubit")", FaultKind::Invalid, "UNIT_UNKNOWN", "/unit"},
        {R"("unit": 1)", FaultKind::Invalid, "WRONG_TYPE", "/unit"},
        {R"("name": null)", FaultKind::Invalid, "WRONG_TYPE", "/name"},
        {R"("colour": "green")", FaultKind::Invalid, "MEMBER_UNKNOWN", "/colour"},
        {R"("mesh": 1)", FaultKind::Invalid, "MEMBER_REPEATED", "/mesh"},
    };
    for (const BadBody& bad : cases) {
        SCOPED_TRACE(bad.body);
        const auto terrain = read_terrain_json("{" + mesh + ", " + bad.body + "}", {});
        ASSERT_FALSE(terrain.ok());
        EXPECT_EQ(terrain.kind(), bad.kind);
        ASSERT_EQ(terrain.faults().size(), 1U);
        EXPECT_EQ(terrain.faults()[0].code, bad.code);
        EXPECT_EQ(terrain.faults()[0].pointer, bad.pointer);
    }
}

TEST(TerrainJson, TellsKnownMembersWhenOneIsUnknown) {
    const auto terrain = read_terrain_json(R"({"mess": {}})", {});
    ASSERT_FALSE(terrain.ok());
    EXPECT_NE(terrain.faults()[0].detail.find("name, crs, unit, mesh, points, grid"),
              std::string::npos);
}

TEST(TerrainJson, TakesAMeshAsTheWholeBody) {
    const auto terrain = read_terrain_json(
        R"({"vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]], "name": "T"})", {});
    ASSERT_TRUE(terrain.ok());
    EXPECT_EQ(terrain->mesh.triangles.size(), 1U);
    EXPECT_EQ(terrain->mesh_pointer, "");
    const auto half = read_terrain_json(R"({"vertices": [[0,0,0],[1,0,0],[0,1,0]]})", {});
    ASSERT_FALSE(half.ok());
    EXPECT_EQ(half.faults()[0].code, "MEMBER_MISSING");
    const auto both = read_terrain_json(
        R"({"vertices": [], "triangles": [], "points": [[0,0,0],[1,0,0],[0,1,0]]})", {});
    ASSERT_FALSE(both.ok());
    EXPECT_EQ(both.faults()[0].code, "TERRAIN_REPEATED");
}

TEST(TerrainJson, TellsAllFaultsAtOnce) {
    const auto terrain = read_terrain_json(
        R"({"name": 1, "mesh": {"vertices": [[0, 0], [1, 1e300, true]], "triangles": [[-1]]}})",
        {});
    ASSERT_FALSE(terrain.ok());
    std::vector<std::string> pointers;
    for (const Fault& fault : terrain.faults())
        pointers.push_back(fault.pointer);
    EXPECT_EQ(pointers, (std::vector<std::string>{"/name", "/mesh/vertices/0", "/mesh/vertices/1/1",
                                                  "/mesh/vertices/1/2", "/mesh/triangles/0/0",
                                                  "/mesh/triangles/0"}));
}

TEST(TerrainJson, AFaultElsewhereHidesNoneOfTheGrid) {
    const auto terrain = read_terrain_json(
        R"({"name": 1, "grid": {"origin": [0,0], "cell": [1,1], "columns": 2, "rows": 2,
                     "elevations": [1,2,3]}})",
        {});
    ASSERT_FALSE(terrain.ok());
    ASSERT_EQ(terrain.faults().size(), 2U);
    EXPECT_EQ(terrain.faults()[1].pointer, "/grid/elevations");
}

TEST(TerrainJson, OneTerrainOnly) {
    const auto terrain = read_terrain_json(
        R"({"mesh": {"vertices": [], "triangles": []},
            "grid": {"origin": [0,0], "cell": [1,1], "columns": 2, "rows": 2,
                     "elevations": [1,2,3,4]}})",
        {});
    ASSERT_FALSE(terrain.ok());
    EXPECT_EQ(terrain.faults()[0].code, "TERRAIN_REPEATED");
}

TEST(TerrainJson, StopsAtTheLimits) {
    ReadLimits limits;
    limits.max_vertices = 3;
    limits.max_triangles = 1;
    const auto vertices = read_terrain_json(
        R"({"mesh": {"vertices": [[0,0,0],[0,0,0],[0,0,0],[0,0,0]], "triangles": []}})", limits);
    ASSERT_FALSE(vertices.ok());
    EXPECT_EQ(vertices.kind(), FaultKind::TooLarge);
    EXPECT_EQ(vertices.faults()[0].pointer, "/mesh/vertices/3");
    const auto triangles = read_terrain_json(
        R"({"mesh": {"vertices": [[0,0,0]], "triangles": [[0,1,2],[0,1,2]]}})", limits);
    ASSERT_FALSE(triangles.ok());
    EXPECT_EQ(triangles.faults()[0].code, "TOO_MANY_TRIANGLES");
    const auto grid = read_terrain_json(R"({"grid": {"elevations": [1,2,3,4,5,6]}})", limits);
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.faults()[0].pointer, "/grid/elevations/3");
    limits.max_vertices = 4;
    const auto posts = read_terrain_json(
        R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 2, "rows": 2,
                     "elevations": [1,2,3,4]}})",
        limits);
    ASSERT_FALSE(posts.ok());
    EXPECT_EQ(posts.faults()[0].code, "TOO_MANY_TRIANGLES");
    EXPECT_EQ(posts.faults()[0].pointer, "/grid");
}

}  // namespace
}  // namespace tinsmith::api
