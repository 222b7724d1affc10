// SPDX-License-Identifier: Apache-2.0
// Positions brought into another system against GDAL's ogr2ogr.
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/shape_crs.hpp"
#include "api/projection.hpp"
#include "tests/gdal/gdal_programs.hpp"

namespace tinsmith {
namespace {

using api::PolygonRequest;
using core::Point2;

const std::string kData = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/";

PolygonRequest read(const std::string& body) {
    auto request = api::read_geojson(body, {});
    if (request) return *std::move(request);
    ADD_FAILURE() << request.faults()[0].detail << "\n" << body.substr(0, 200);
    return {};
}

std::vector<core::Shape> shapes_of(const PolygonRequest& request) {
    std::vector<core::Shape> shapes;
    for (const api::RequestedShape& shape : request.shapes)
        shapes.push_back(shape.shape);
    return shapes;
}

std::string ogr2ogr(const std::string& from, const std::string& to, const std::string& body) {
    const testing::Workshop shop;
    shop.write("in.geojson", body);
    shop.run("ogr2ogr -f GeoJSON -lco COORDINATE_PRECISION=12 -s_srs " + from + " -t_srs " + to +
             " out.geojson in.geojson");
    return shop.read("out.geojson");
}

/// Both ways of going there end within a millimetre of one another.
void expect_same(const std::string& from, const std::string& to, const std::string& body) {
    SCOPED_TRACE(from + " to " + to);
    const PolygonRequest request = read(body);
    auto ours = shapes_of(request);
    const auto faults = api::bring_into(to, {from, ""}, ours, request.shapes, 100);
    ASSERT_TRUE(faults.empty()) << faults[0].detail;
    const auto theirs = shapes_of(read(ogr2ogr(from, to, body)));
    const auto facts = api::find_crs(to);
    ASSERT_TRUE(facts);
    ASSERT_EQ(ours.size(), theirs.size());
    std::size_t points = 0;
    for (std::size_t s = 0; s < ours.size(); ++s) {
        ASSERT_EQ(ours[s].paths.size(), theirs[s].paths.size());
        for (std::size_t p = 0; p < ours[s].paths.size(); ++p) {
            const auto& a = ours[s].paths[p].points;
            const auto& b = theirs[s].paths[p].points;
            ASSERT_EQ(a.size(), b.size());
            for (std::size_t i = 0; i < a.size(); ++i, ++points)
                EXPECT_LT(std::hypot(a[i].x - b[i].x, a[i].y - b[i].y) * facts->metres, 0.001)
                    << a[i].x << " " << a[i].y << " and " << b[i].x << " " << b[i].y;
        }
    }
    EXPECT_GE(points, 4U);
}

/// A polygon of some kilometres around a place in degrees.
std::string around(double longitude, double latitude) {
    std::string ring;
    constexpr std::array<std::array<double, 2>, 6> corners{
        {{0, 0}, {0.03, 0.004}, {0.041, 0.02}, {0.02, 0.0312345678}, {-0.01, 0.017}, {0, 0}}};
    for (const auto& [dx, dy] : corners) {
        std::array<char, 80> text{};
        std::snprintf(text.data(), text.size(), "%s[%.10f,%.10f]", ring.empty() ? "" : ",",
                      longitude + dx, latitude + dy);
        ring += text.data();
    }
    return R"({"type": "Polygon", "coordinates": [[)" + ring + "]]}";
}

TEST(Systems, DegreesLandWhereOgr2ogrPutsThem) {
    expect_same("EPSG:4326", "EPSG:32616", around(-84.12, 36.34));
    expect_same("EPSG:4326", "EPSG:2274", around(-84.12, 36.34));  // Tennessee, US survey feet
    expect_same("EPSG:4326", "EPSG:2263", around(-73.98, 40.74));  // New York, US survey feet
    expect_same("EPSG:4269", "EPSG:2263", around(-73.98, 40.74));
    expect_same("EPSG:4326", "EPSG:2222", around(-111.0, 34.0));  // Arizona, feet
    expect_same("EPSG:4326", "EPSG:3857", around(-84.12, 36.34));
    expect_same("EPSG:4326", "EPSG:2154", around(2.34, 48.85));
    expect_same("EPSG:4326", "EPSG:27700", around(-0.13, 51.5));  // without its grid
    expect_same("EPSG:4326", "EPSG:2180", around(21.0, 52.2));    // northing first, in the list
    expect_same("EPSG:4326", "EPSG:31467", around(9.0, 48.7));
    expect_same("OGC:CRS84", "EPSG:32760", around(174.78, -41.29));
    expect_same("EPSG:4979", "EPSG:32632", around(9.0, 48.7));
}

TEST(Systems, ProjectedOnesLandWhereOgr2ogrPutsThem) {
    const testing::Workshop shop;
    const std::string lake = shop.run("cat " + kData + "lake.geojson");
    for (const char* to : {"EPSG:32617", "EPSG:2274", "EPSG:3857", "EPSG:5070"})
        expect_same("EPSG:32616", to, lake);
    const auto via = [](const std::string& system, double longitude, double latitude) {
        return ogr2ogr("EPSG:4326", system, around(longitude, latitude));
    };
    expect_same("EPSG:3857", "EPSG:32616", via("EPSG:3857", -84.12, 36.34));
    expect_same("EPSG:2263", "EPSG:32618", via("EPSG:2263", -73.98, 40.74));
    expect_same("EPSG:27700", "EPSG:32630", via("EPSG:27700", -2.1, 53.4));
    expect_same("EPSG:26716", "EPSG:32616", via("EPSG:26716", -84.12, 36.34));  // NAD27
}

TEST(Systems, TheLakeDrawnInDegreesIsTheLake) {
    const testing::Workshop shop;
    const std::string lake = shop.run("cat " + kData + "lake.geojson");
    const auto there = shapes_of(read(lake));
    const PolygonRequest degrees = read(ogr2ogr("EPSG:32616", "EPSG:4326", lake));
    auto back = shapes_of(degrees);
    ASSERT_TRUE(
        api::bring_into("EPSG:32616", {"EPSG:4326", ""}, back, degrees.shapes, 100).empty());
    const auto& a = there[0].paths[0].points;
    const auto& b = back[0].paths[0].points;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_LT(std::hypot(a[i].x - b[i].x, a[i].y - b[i].y), 0.001) << i;
}

}  // namespace
}  // namespace tinsmith
