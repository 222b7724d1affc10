// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson.hpp"

#include <string>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

using core::Point2;
using Pairs = std::vector<std::pair<std::string, std::string>>;

TEST(GeoJson, ReadsAPolygonWithAHole) {
    const auto request = read_geojson(
        R"({"type": "Polygon", "coordinates": [
              [[0, 0], [10, 0], [10, 10.5], [0, 10], [0, 0]],
              [[2, 2, 99], [2, 4, 99, "m"], [4, 4, 1], [2, 2, 7]]]})",
        {});
    ASSERT_TRUE(request.ok());
    ASSERT_EQ(request->shapes.size(), 1U);
    const RequestedShape& shape = request->shapes[0];
    EXPECT_EQ(shape.type, GeometryType::Polygon);
    EXPECT_EQ(shape.properties, "{}");
    EXPECT_EQ(shape.pointer, "");
    ASSERT_EQ(shape.shape.paths.size(), 2U);
    EXPECT_TRUE(shape.shape.paths[0].closed);
    EXPECT_EQ(shape.shape.paths[0].points,
              (std::vector<Point2>{{0, 0}, {10, 0}, {10, 10.5}, {0, 10}}));
    EXPECT_EQ(shape.shape.paths[1].points, (std::vector<Point2>{{2, 2}, {2, 4}, {4, 4}}));
    EXPECT_EQ(coordinate_pointer(shape, 1, 2), "/coordinates/1/2");
}

TEST(GeoJson, MembersMayComeInAnyOrder) {
    const auto request = read_geojson(
        R"({"features": [{"properties": {"coordinates": [1]},
                          "geometry": {"coordinates": [[0, 0], [5, 5]], "bbox": [0, 0, 5, 5],
                                       "type": "LineString"},
                          "id": 7, "type": "Feature"}],
            "crs": {"properties": {"name": "urn:ogc:def:crs:EPSG::32616"}, "type": "name"},
            "tinsmith": {"elevation": "drape", "snap": 0.250, "lock": true, "n": -3},
            "name": "layer", "type": "FeatureCollection"})",
        {});
    ASSERT_TRUE(request.ok());
    EXPECT_EQ(request->crs, "EPSG:32616");
    EXPECT_EQ(request->options,
              (Pairs{{"elevation", "drape"}, {"snap", "0.250"}, {"lock", "true"}, {"n", "-3"}}));
    ASSERT_EQ(request->shapes.size(), 1U);
    const RequestedShape& shape = request->shapes[0];
    EXPECT_EQ(shape.id, "7");
    EXPECT_EQ(shape.properties, R"({"coordinates":[1]})");
    EXPECT_EQ(shape.pointer, "/features/0/geometry");
    ASSERT_EQ(shape.shape.paths.size(), 1U);
    EXPECT_FALSE(shape.shape.paths[0].closed);
    EXPECT_EQ(coordinate_pointer(shape, 0, 1), "/features/0/geometry/coordinates/1");
}

TEST(GeoJson, AFeatureKeepsNothingOfTheOneBefore) {
    const auto request = read_geojson(
        R"({"type": "FeatureCollection", "features": [
              {"type": "Feature", "id": "a", "properties": {"p": 1},
               "geometry": {"type": "Point", "coordinates": [1, 2]}},
              {"type": "Feature", "geometry": {"type": "MultiPoint",
                                               "coordinates": [[3, 4], [5, 6]]}}]})",
        {});
    ASSERT_TRUE(request.ok());
    ASSERT_EQ(request->shapes.size(), 2U);
    EXPECT_EQ(request->shapes[0].shape.paths.at(0).points, (std::vector<Point2>{{1, 2}}));
    EXPECT_EQ(coordinate_pointer(request->shapes[0], 0, 0), "/features/0/geometry/coordinates");
    EXPECT_EQ(request->shapes[1].id, "");
    EXPECT_EQ(request->shapes[1].properties, "{}");
    ASSERT_EQ(request->shapes[1].shape.paths.size(), 2U);
    EXPECT_EQ(coordinate_pointer(request->shapes[1], 1, 0), "/features/1/geometry/coordinates/1");
}

TEST(GeoJson, KeepsAnIdAsItWasWritten) {
    const auto id_of = [](const std::string& id) {
        return read_geojson(R"({"type": "Feature", "id": )" + id +
                                R"(, "geometry": {"type": "Point", "coordinates": [1, 2]}})",
                            {})
            ->shapes.at(0)
            .id;
    };
    EXPECT_EQ(id_of("7"), "7");
    EXPECT_EQ(id_of("7.50"), "7.50");
    EXPECT_EQ(id_of(R"("7")"), R"("7")");
    EXPECT_EQ(id_of(R"("a\"b")"), R"("a\"b")");
}

TEST(GeoJson, MultiPolygonsAndMultiLinesAreOneShape) {
    const auto polygons = read_geojson(
        R"({"type": "Feature", "properties": null, "geometry": {"type": "MultiPolygon",
            "coordinates": [[[[0,0],[1,0],[1,1],[0,0]], [[0.2,0.1],[0.3,0.1],[0.3,0.2],[0.2,0.1]]],
                            [[[5,5],[6,5],[6,6],[5,5]]]]}})",
        {});
    ASSERT_TRUE(polygons.ok());
    const RequestedShape& shape = polygons->shapes.at(0);
    ASSERT_EQ(shape.shape.paths.size(), 3U);
    EXPECT_EQ(shape.shape.paths[2].points, (std::vector<Point2>{{5, 5}, {6, 5}, {6, 6}}));
    EXPECT_EQ(coordinate_pointer(shape, 1, 2), "/geometry/coordinates/0/1/2");
    EXPECT_EQ(coordinate_pointer(shape, 2, 0), "/geometry/coordinates/1/0/0");
    const auto lines = read_geojson(
        R"({"type": "MultiLineString", "coordinates": [[[0,0],[1,1]], [[2,2],[3,3],[4,4]]]})", {});
    ASSERT_TRUE(lines.ok());
    ASSERT_EQ(lines->shapes.at(0).shape.paths.size(), 2U);
    EXPECT_EQ(coordinate_pointer(lines->shapes[0], 1, 2), "/coordinates/1/2");
}

struct BadBody {
    std::string body;
    FaultKind kind;
    std::string code;
    std::string pointer;
};

void expect_fault(const BadBody& bad) {
    SCOPED_TRACE(bad.body);
    const auto request = read_geojson(bad.body, {});
    ASSERT_FALSE(request.ok());
    EXPECT_EQ(request.kind(), bad.kind);
    ASSERT_EQ(request.faults().size(), 1U) << request.faults()[1].code;
    EXPECT_EQ(request.faults()[0].code, bad.code) << request.faults()[0].detail;
    EXPECT_EQ(request.faults()[0].pointer, bad.pointer);
}

std::string geometry(const std::string& type, const std::string& coordinates) {
    return R"({"coordinates": )" + coordinates + R"(, "type": ")" + type + "\"}";
}

TEST(GeoJson, FaultsOfCoordinates) {
    constexpr auto invalid = FaultKind::Invalid;
    const BadBody cases[] = {
        {geometry("Point", "[]"), invalid, "SHAPE_EMPTY", "/coordinates"},
        {geometry("Point", "[1]"), invalid, "POSITION_TOO_SHORT", "/coordinates"},
        {geometry("Point", "[1, true]"), invalid, "WRONG_TYPE", "/coordinates/1"},
        {geometry("Point", "null"), invalid, "WRONG_TYPE", "/coordinates"},
        {geometry("Point", "{}"), invalid, "WRONG_TYPE", "/coordinates"},
        {geometry("Point", "[[1, 2]]"), invalid, "COORDINATES_NESTING", "/coordinates"},
        {geometry("Point", "[1, 2e9]"), invalid, "COORDINATE_OUT_OF_RANGE", "/coordinates/1"},
        {geometry("Point", "[1, 2, 2e9]"), invalid, "COORDINATE_OUT_OF_RANGE", "/coordinates/2"},
        {geometry("Point", "[1, 1e400]"), invalid, "NUMBER_OUT_OF_RANGE", "/coordinates/1"},
        {geometry("Point", "[1, [2]]"), invalid, "WRONG_TYPE", "/coordinates/1"},
        {geometry("MultiPoint", "[]"), invalid, "SHAPE_EMPTY", "/coordinates"},
        {geometry("MultiPoint", "[[1, 2], []]"), invalid, "POSITION_TOO_SHORT", "/coordinates/1"},
        {geometry("MultiPoint", "[[], [1, 2]]"), invalid, "COORDINATES_NESTING", "/coordinates/1"},
        {geometry("MultiPoint", "[[1, 2], 3]"), invalid, "WRONG_TYPE", "/coordinates/1"},
        {geometry("MultiPoint", "[null, [1, 2]]"), invalid, "WRONG_TYPE", "/coordinates/0"},
        {geometry("LineString", "[]"), invalid, "LINE_TOO_SHORT", "/coordinates"},
        {geometry("LineString", "[[1, 2]]"), invalid, "LINE_TOO_SHORT", "/coordinates"},
        {geometry("LineString", "[[1, 2], [1, 2]]"), invalid, "LINE_TOO_SHORT", "/coordinates"},
        {geometry("LineString", "[[1, 2], [3]]"), invalid, "POSITION_TOO_SHORT", "/coordinates/1"},
        {geometry("MultiLineString", "[[[1, 2], [3, 4]], []]"), invalid, "LINE_TOO_SHORT",
         "/coordinates/1"},
        {geometry("Polygon", "[]"), invalid, "SHAPE_EMPTY", "/coordinates"},
        {geometry("Polygon", "[[]]"), invalid, "RING_TOO_SHORT", "/coordinates/0"},
        {geometry("Polygon", "[[[0,0],[1,0],[1,1]]]"), invalid, "RING_TOO_SHORT", "/coordinates/0"},
        {geometry("Polygon", "[[[0,0],[1,0],[0,0],[1,0],[0,0]]]"), invalid, "RING_TOO_SHORT",
         "/coordinates/0"},
        {geometry("Polygon", "[[[0,0],[1,0],[1,1],[0,1]]]"), invalid, "RING_NOT_CLOSED",
         "/coordinates/0/3"},
        {geometry("Polygon", "[[[0,0],[1,0],[\"1\",1],[0,1]]]"), invalid, "WRONG_TYPE",
         "/coordinates/0/2/0"},
        {geometry("Polygon", "[[0,0],[1,0],[1,1],[0,0]]"), invalid, "COORDINATES_NESTING",
         "/coordinates"},
        {geometry("Polygon", "[[[0,0],[1,0],[1,1],[0,0]], [0,0]]"), invalid, "COORDINATES_NESTING",
         "/coordinates/1"},
        {geometry("Polygon", "[[[0,0],[1,0],[1,1],[0,0]], [[[0,0]]]]"), invalid,
         "COORDINATES_NESTING", "/coordinates/1/0/0"},
        {geometry("MultiPolygon", "[[]]"), invalid, "SHAPE_EMPTY", "/coordinates"},
        {geometry("MultiPolygon", "[[], [[[0,0],[1,0],[1,1],[0,0]]]]"), invalid, "SHAPE_EMPTY",
         "/coordinates/0"},
        {geometry("MultiPolygon", "[[[[0,0],[1,0],[1,1],[0,0]]], [[[0,0],[1,1]]]]"), invalid,
         "RING_TOO_SHORT", "/coordinates/1/0"},
        {geometry("MultiPolygon", "[[[[[0,0]]]]]"), invalid, "COORDINATES_NESTING",
         "/coordinates/0/0/0/0"},
    };
    for (const BadBody& bad : cases)
        expect_fault(bad);
}

TEST(GeoJson, FaultsAroundCoordinates) {
    constexpr auto invalid = FaultKind::Invalid;
    const std::string point = R"({"type": "Point", "coordinates": [1, 2]})";
    const auto feature = [](const std::string& rest) {
        return R"({"type": "FeatureCollection", "features": [{"type": "Feature", )" + rest + "}]}";
    };
    const BadBody cases[] = {
        {"", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"[]", invalid, "WRONG_TYPE", ""},
        {"{}", invalid, "MEMBER_MISSING", ""},
        {R"({"type": "Pointe"})", invalid, "GEOJSON_TYPE", "/type"},
        {R"({"type": "Pointe", "coordinates": [1, 2]})", invalid, "GEOJSON_TYPE", "/type"},
        {R"({"type": 3})", invalid, "WRONG_TYPE", "/type"},
        {R"({"type": "Point"})", invalid, "MEMBER_MISSING", ""},
        {R"({"type": "Feature"})", invalid, "MEMBER_MISSING", ""},
        {R"({"type": "FeatureCollection"})", invalid, "MEMBER_MISSING", ""},
        {R"({"type": "Feature", "geometry": null})", invalid, "SHAPE_EMPTY", "/geometry"},
        {R"({"type": "FeatureCollection", "features": []})", invalid, "SHAPE_EMPTY", "/features"},
        {R"({"type": "FeatureCollection", "features": [null]})", invalid, "WRONG_TYPE",
         "/features/0"},
        {R"({"type": "FeatureCollection", "features": [)" + point + "]}", invalid, "MEMBER_MISSING",
         "/features/0"},
        {R"({"type": "GeometryCollection", "geometries": [)" + point + "]}", FaultKind::Unsupported,
         "GEOMETRY_COLLECTION_UNSUPPORTED", ""},
        {R"({"type": "Point", "coordinates": [1, 2], "geometry": )" + point + "}", invalid,
         "MEMBER_NOT_ALLOWED", "/geometry"},
        {R"({"type": "Feature", "geometry": )" + point + R"(, "coordinates": [1, 2]})", invalid,
         "MEMBER_NOT_ALLOWED", "/coordinates"},
        {feature(R"("geometry": null)"), invalid, "SHAPE_EMPTY", "/features/0/geometry"},
        {feature(R"("geometry": {"type": "GeometryCollection", "geometries": []})"),
         FaultKind::Unsupported, "GEOMETRY_COLLECTION_UNSUPPORTED", "/features/0/geometry"},
        {feature(R"("geometry": {"type": "Point"})"), invalid, "MEMBER_MISSING",
         "/features/0/geometry"},
        {feature(R"("geometry": {"type": "Feature", "coordinates": [0, 0]})"), invalid,
         "GEOJSON_TYPE", "/features/0/geometry/type"},
        {feature(R"("geometry": )" + point + R"(, "properties": 3)"), invalid, "WRONG_TYPE",
         "/features/0/properties"},
        {feature(R"("geometry": )" + point + R"(, "properties": {"a": {"b": 1, "b": 2}})"), invalid,
         "MEMBER_REPEATED", "/features/0/properties/a/b"},
        {feature(R"("geometry": )" + point + R"(, "id": [])"), invalid, "WRONG_TYPE",
         "/features/0/id"},
        {feature(R"("geometry": )" + point + R"(, "geometry": )" + point), invalid,
         "MEMBER_REPEATED", "/features/0/geometry"},
    };
    for (const BadBody& bad : cases)
        expect_fault(bad);
}

TEST(GeoJson, FaultsOfOptionsAndCrs) {
    const std::string start = R"({"type": "Point", "coordinates": [1, 2], )";
    constexpr auto invalid = FaultKind::Invalid;
    const BadBody cases[] = {
        {start + R"("tinsmith": 3})", invalid, "WRONG_TYPE", "/tinsmith"},
        {start + R"("tinsmith": {"snap": null}})", invalid, "WRONG_TYPE", "/tinsmith/snap"},
        {start + R"("tinsmith": {"snap": [1]}})", invalid, "WRONG_TYPE", "/tinsmith/snap"},
        {start + R"("tinsmith": {"snap": 1, "snap": 1}})", invalid, "MEMBER_REPEATED",
         "/tinsmith/snap"},
        {start + R"("crs": "EPSG:32616"})", invalid, "WRONG_TYPE", "/crs"},
        {start + R"("crs": {"type": "name"}})", invalid, "MEMBER_MISSING", "/crs"},
        {start + R"("crs": {"type": "name", "properties": {}}})", invalid, "MEMBER_MISSING",
         "/crs/properties"},
        {start + R"("crs": {"type": "name", "properties": {"name": "here"}}})", invalid,
         "CRS_UNKNOWN", "/crs"},
        {start + R"("crs": {"type": "link", "properties": {"href": "x", "name": "EPSG:1"}}})",
         invalid, "CRS_UNKNOWN", "/crs"},
    };
    for (const BadBody& bad : cases)
        expect_fault(bad);
    const auto none = read_geojson(start + R"("crs": null, "tinsmith": {}})", {});
    ASSERT_TRUE(none.ok());
    EXPECT_EQ(none->crs, "");
}

TEST(GeoJson, OptionsAreReadAtTheTopOnly) {
    const auto request = read_geojson(
        R"({"type": "FeatureCollection", "features": [{"type": "Feature", "tinsmith": {"a": 1},
            "crs": 5, "geometry": {"type": "Point", "coordinates": [1, 2], "tinsmith": 4}}]})",
        {});
    ASSERT_TRUE(request.ok());
    EXPECT_TRUE(request->options.empty());
}

TEST(GeoJson, RingFaultsTellTheCoordinate) {
    const auto request =
        read_geojson(geometry("Polygon", "[[[7,8],[1,0],[1,1]], [[0,0],[1,0],[1,1],[5,6]]]"), {});
    ASSERT_FALSE(request.ok());
    ASSERT_EQ(request.faults().size(), 2U);
    EXPECT_EQ(request.faults()[0].coordinate, (std::array<double, 2>{7, 8}));
    EXPECT_EQ(request.faults()[1].coordinate, (std::array<double, 2>{5, 6}));
}

TEST(GeoJson, TellsAllFaultsAtOnceUpToAHundred) {
    std::string body = R"({"type": "FeatureCollection", "features": [)";
    for (int i = 0; i < 150; ++i) {
        if (i > 0) body += ',';
        body += R"({"type": "Feature", "geometry": )" +
                geometry("LineString", "[[" + std::to_string(i) + ",0]]") + "}";
    }
    const auto request = read_geojson(body + "]}", {});
    ASSERT_FALSE(request.ok());
    ASSERT_EQ(request.faults().size(), kMaxFaults);
    EXPECT_EQ(request.faults()[99].pointer, "/features/99/geometry/coordinates");
    EXPECT_EQ(request.faults()[99].coordinate, (std::array<double, 2>{99, 0}));
}

TEST(GeoJson, TooManyPositionsStopTheReading) {
    ReadLimits limits;
    limits.max_polygon_vertices = 4;
    const auto over = read_geojson(
        R"({"type": "MultiPoint", "coordinates": [[0,0],[1,0],[1,1],[0,1],[5,5],)", limits);
    ASSERT_FALSE(over.ok());
    EXPECT_EQ(over.kind(), FaultKind::TooLarge);
    EXPECT_EQ(over.faults()[0].pointer, "/coordinates/4/0");
    const auto arrays = read_geojson(R"({"coordinates": [[],[],[],[],[],[)", limits);
    ASSERT_FALSE(arrays.ok());
    EXPECT_EQ(arrays.kind(), FaultKind::TooLarge);
    const auto within = read_geojson(geometry("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]"), limits);
    EXPECT_TRUE(within.ok());
}

TEST(GeoJson, AMillionPositionsInOneRing) {
    constexpr std::size_t count = 1'000'000;
    std::string body = R"({"type": "Polygon", "coordinates": [[)";
    for (std::size_t i = 0; i + 1 < count; ++i) {
        body += "[" + std::to_string(700000 + i % 1000) + ".25," + std::to_string(i) + "],";
    }
    body += "[700000.25,0]]]}";
    const auto request = read_geojson(body, {});
    ASSERT_TRUE(request.ok());
    const core::Path& ring = request->shapes.at(0).shape.paths.at(0);
    EXPECT_EQ(ring.points.size(), count - 1);
    EXPECT_EQ(coordinate_pointer(request->shapes[0], 0, 999), "/coordinates/0/999");
    EXPECT_LE(ring.points.capacity() * sizeof(Point2), body.size());
}

TEST(GeoJson, TenMegabytesOfBracketsAreRefused) {
    const auto request =
        read_geojson(R"({"type": "Polygon", "coordinates": )" + std::string(10'000'000, '['), {});
    ASSERT_FALSE(request.ok());
    EXPECT_EQ(request.kind(), FaultKind::Syntax);
    EXPECT_EQ(request.faults().back().code, "JSON_TOO_DEEP");
}

}  // namespace
}  // namespace tinsmith::api
