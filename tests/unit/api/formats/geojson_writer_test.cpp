// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_writer.hpp"

#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tinsmith::api {
namespace {

using nlohmann::json;

DrapedPolygon polygon_of(GeometryType type, std::vector<DrapedLine> lines) {
    DrapedPolygon polygon;
    polygon.id = "p1";
    polygon.properties = "{}";
    polygon.type = type;
    polygon.paths = lines.size();
    polygon.lines = std::move(lines);
    return polygon;
}

DrapedLine ring(std::size_t path, double x) {
    return {path, {{x, 0, 1}, {x + 1, 0, 2}, {x, 1, 3}, {x, 0, 1}}};
}

json geometry_of(const DrapedPolygon& polygon) {
    return json::parse(write_feature(polygon, ""))["geometry"];
}

TEST(WriteFeature, HasTheAgreedShape) {
    DrapedPolygon polygon = polygon_of(GeometryType::Polygon, {ring(0, 0.5)});
    polygon.client_id = "7";
    polygon.properties = R"({"name":"pond","depth":1.50})";
    polygon.region = {core::Winding::NonZero, 0.5, 0.75, 3};
    EXPECT_EQ(write_feature(polygon, "EPSG:32616"),
              R"({"type":"Feature","id":7,"geometry":{"type":"Polygon","coordinates":)"
              R"([[[0.5,0,1],[1.5,0,2],[0.5,1,3],[0.5,0,1]]]},)"
              R"("properties":{"name":"pond","depth":1.50},)"
              R"("tinsmith":{"id":"p1","partly_outside":false,"winding":"nonzero",)"
              R"("plan_area":0.5,"surface_area":0.75,"triangles":3},)"
              R"("crs":{"type":"name","properties":{"name":"EPSG:32616"}}})"
              "\n");
}

TEST(WriteFeature, WritesEveryGeometry) {
    const DrapedLine line{0, {{0, 0, 1}, {1, 1, 2}}};
    EXPECT_EQ(geometry_of(polygon_of(GeometryType::Point, {{0, {{1, 2, 3}}}})),
              json::parse(R"({"type": "Point", "coordinates": [1,2,3]})"));
    EXPECT_EQ(
        geometry_of(polygon_of(GeometryType::MultiPoint, {{0, {{1, 2, 3}}}, {1, {{4, 5, 6}}}})),
        json::parse(R"({"type": "MultiPoint", "coordinates": [[1,2,3],[4,5,6]]})"));
    EXPECT_EQ(geometry_of(polygon_of(GeometryType::LineString, {line})),
              json::parse(R"({"type": "LineString", "coordinates": [[0,0,1],[1,1,2]]})"));
    EXPECT_EQ(geometry_of(polygon_of(GeometryType::MultiLineString, {line})),
              json::parse(R"({"type": "MultiLineString", "coordinates": [[[0,0,1],[1,1,2]]]})"));
    DrapedPolygon two =
        polygon_of(GeometryType::MultiPolygon, {ring(0, 0), ring(1, 0.25), ring(2, 9)});
    two.polygon_starts = {0, 2};
    const json written = geometry_of(two);
    EXPECT_EQ(written["type"], "MultiPolygon");
    ASSERT_EQ(written["coordinates"].size(), 2U);
    EXPECT_EQ(written["coordinates"][0].size(), 2U);
    EXPECT_EQ(written["coordinates"][1][0][0], json::parse("[9,0,1]"));
}

TEST(WriteFeature, WritesTheLinesOfWhatIsNotWhole) {
    DrapedPolygon part = polygon_of(GeometryType::Polygon, {{0, {{0, 0, 1}, {1, 1, 2}}}});
    part.partly_outside = true;
    EXPECT_EQ(geometry_of(part),
              json::parse(R"({"type": "MultiLineString", "coordinates": [[[0,0,1],[1,1,2]]]})"));
    DrapedPolygon touching = polygon_of(GeometryType::LineString, {{0, {{0, 0, 1}}}});
    touching.partly_outside = true;
    EXPECT_TRUE(geometry_of(touching).is_null()) << "one position is no line";
    EXPECT_TRUE(geometry_of(polygon_of(GeometryType::MultiPoint, {})).is_null());
    // A ring that was snapped onto a single edge.
    const DrapedPolygon flat =
        polygon_of(GeometryType::Polygon, {{0, {{0, 0, 1}, {1, 1, 2}, {0, 0, 1}}}});
    EXPECT_EQ(geometry_of(flat)["type"], "MultiLineString");
}

TEST(WriteFeatureCollection, ReadsBack) {
    const std::array polygons{polygon_of(GeometryType::Polygon, {ring(0, 0.5)}),
                              polygon_of(GeometryType::Point, {{0, {{1, 2, 3}}}})};
    const auto request = read_geojson(write_feature_collection(polygons, "EPSG:32616"), {});
    ASSERT_TRUE(request.ok());
    EXPECT_EQ(request->crs, "EPSG:32616");
    EXPECT_TRUE(request->options.empty()) << "what we say of a Feature is no wish";
    ASSERT_EQ(request->shapes.size(), 2U);
    EXPECT_EQ(request->shapes[0].shape.paths.at(0).elevations, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(json::parse(write_feature_collection({}, "")),
              json::parse(R"({"type": "FeatureCollection", "features": []})"));
}

}  // namespace
}  // namespace tinsmith::api
