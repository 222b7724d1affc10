// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_elevations.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

PolygonRequest read(const std::string& body) {
    auto request = read_geojson(body, {});
    EXPECT_TRUE(request.ok()) << body;
    return request ? std::move(*request) : PolygonRequest{};
}

/// "CODE pointer" of each fault, a line each.
std::string told(const std::string& body) {
    std::string lines;
    for (const Fault& fault : elevation_faults(read(body).shapes, kMaxFaults))
        lines += fault.code + " " + fault.pointer + "\n";
    return lines;
}

TEST(Elevations, AreOneForEachPoint) {
    const auto request = read(R"({"type": "Polygon", "coordinates": [
        [[0,0,1],[9,0,2.5],[9,9,-3,"m"],[0,0,1]], [[1,1,0],[2,1,-0.0],[2,2,0],[1,1,-0.0]]]})");
    EXPECT_TRUE(elevation_faults(request.shapes, kMaxFaults).empty());
    const auto& paths = request.shapes.at(0).shape.paths;
    ASSERT_EQ(paths.size(), 2U);
    EXPECT_EQ(paths[0].elevations, (std::vector<double>{1, 2.5, -3}));
    EXPECT_EQ(paths[1].elevations, (std::vector<double>{0, 0, 0}));
}

TEST(Elevations, BelongToTheirOwnPath) {
    const auto request = read(R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": {"type": "MultiPoint",
                                         "coordinates": [[1,2,3],[4,5,6]]}},
        {"type": "Feature", "geometry": {"type": "Point", "coordinates": [7,8,9]}},
        {"type": "Feature", "geometry": {"type": "MultiPolygon", "coordinates": [
            [[[0,0,1],[1,0,2],[1,1,3],[0,0,1]]], [[[5,5,4],[6,5,5],[6,6,6],[5,5,4]]]]}},
        {"type": "Feature", "geometry": {"type": "MultiLineString",
                                         "coordinates": [[[0,0,1],[1,1,2]], [[2,2,3],[3,3,4]]]}}]})");
    EXPECT_TRUE(elevation_faults(request.shapes, kMaxFaults).empty());
    const auto elevations = [&](std::size_t shape, std::size_t path) {
        return request.shapes.at(shape).shape.paths.at(path).elevations;
    };
    EXPECT_EQ(elevations(0, 1), std::vector<double>{6});
    EXPECT_EQ(elevations(1, 0), std::vector<double>{9});
    EXPECT_EQ(elevations(2, 1), (std::vector<double>{4, 5, 6}));
    EXPECT_EQ(elevations(3, 1), (std::vector<double>{3, 4}));
}

TEST(Elevations, AreNotMadeUpWhereThereAreNone) {
    const auto request =
        read(R"({"type": "MultiLineString", "coordinates": [[[0,0],[1,1]], [[2,2],[3,3,4]]]})");
    const auto& paths = request.shapes.at(0).shape.paths;
    EXPECT_TRUE(paths.at(0).elevations.empty());
    ASSERT_EQ(paths.at(1).elevations.size(), 2U);
    EXPECT_TRUE(std::isnan(paths[1].elevations[0]));
    EXPECT_EQ(paths[1].elevations[1], 4.0);
}

TEST(Elevations, AreMissedWhereverTheyAre) {
    EXPECT_EQ(told(R"({"type": "Point", "coordinates": [1, 2]})"),
              "ELEVATION_MISSING /coordinates\n");
    EXPECT_EQ(told(R"({"type": "MultiPoint", "coordinates": [[1,2],[3,4,5],[6,7]]})"),
              "ELEVATION_MISSING /coordinates/0\nELEVATION_MISSING /coordinates/2\n");
    EXPECT_EQ(told(R"({"type": "LineString", "coordinates": [[1,2,0],[3,4]]})"),
              "ELEVATION_MISSING /coordinates/1\n");
    EXPECT_EQ(told(R"({"type": "MultiPolygon", "coordinates": [[[[0,0,1],[1,0,1],[1,1,1],[0,0,1]]],
                       [[[5,5,0],[6,5,0],[6,6,0],[5,5,0]], [[5.5,5.2,0],[6,5,0],[6,6],[5.5,5.2]]]]})"),
              "ELEVATION_MISSING /coordinates/1/1/2\nELEVATION_MISSING /coordinates/1/1/3\n");
    EXPECT_EQ(told(R"({"type": "Polygon", "coordinates": [[[0,0],[1,0],[1,1],[0,0,1]]]})"),
              "ELEVATION_MISSING /coordinates/0/0\nELEVATION_MISSING /coordinates/0/1\n"
              "ELEVATION_MISSING /coordinates/0/2\n");
}

TEST(Elevations, AreLengths) {
    EXPECT_EQ(told(R"({"type": "LineString", "coordinates": [[0,0,0.0],[1,0,1e-300],[2,0,1e-9]]})"),
              "COORDINATE_OUT_OF_RANGE /coordinates/1/2\n");
}

TEST(Elevations, CloseTheRingToo) {
    EXPECT_EQ(told(R"({"type": "Polygon", "coordinates": [[[0,0,1],[1,0,1],[1,1,1],[0,0,2]]]})"),
              "RING_NOT_CLOSED /coordinates/0/3\n");
    const auto request = read(R"({"type": "Polygon", "coordinates": [
        [[7,8,1],[1,0,1],[1,1,1],[7,8,2]]]})");
    const Faults faults = elevation_faults(request.shapes, kMaxFaults);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].coordinate, (std::array<double, 2>{7, 8}));
}

TEST(Elevations, AreOneForEachPlace) {
    EXPECT_EQ(told(R"({"type": "LineString", "coordinates": [[0,0,1],[1,0,1],[1,0,5],[2,0,5]]})"),
              "ELEVATION_REPEATED /coordinates/2\n");
    EXPECT_EQ(told(R"({"type": "LineString", "coordinates": [[0,0,1],[1,0,5],[1,0,5],[2,0,5]]})"),
              "");
    EXPECT_EQ(told(R"({"type": "Polygon", "coordinates":
                       [[[0,0,1],[1,0,1],[1,1,1],[0,0,9],[0,0,1]]]})"),
              "ELEVATION_REPEATED /coordinates/0/4\n");
}

TEST(Elevations, AreMissedAHundredTimesAtMost) {
    std::string body = R"({"type": "MultiPoint", "coordinates": [[0,0])";
    for (int i = 1; i < 150; ++i)
        body += ",[" + std::to_string(i) + ",0]";
    const Faults faults = elevation_faults(read(body + "]}").shapes, kMaxFaults);
    ASSERT_EQ(faults.size(), kMaxFaults);
    EXPECT_EQ(faults.back().pointer, "/coordinates/99");
}

TEST(Elevations, AreDroppedWithTheirMemory) {
    auto request = read(R"({"type": "Polygon", "coordinates": [
        [[0,0,1],[9,0,2],[9,9,3],[0,0,4]]]})");
    drop_elevations(request.shapes);
    const RequestedShape& shape = request.shapes.at(0);
    EXPECT_EQ(shape.shape.paths.at(0).elevations.capacity(), 0U);
    EXPECT_EQ(shape.shape.paths.at(0).points.size(), 3U);
    EXPECT_TRUE(shape.closing_elevations.empty());
}

}  // namespace
}  // namespace tinsmith::api
