// SPDX-License-Identifier: Apache-2.0
#include "api/formats/shape_crs.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

constexpr const char* kUtm = "EPSG:32616";

struct Request {
    PolygonRequest read;
    std::vector<core::Shape> shapes;
};

Request request(const std::string& body) {
    auto read = read_geojson(body, {});
    if (!read) {
        ADD_FAILURE() << read.faults()[0].detail;
        return {};
    }
    Request out{*std::move(read), {}};
    for (RequestedShape& shape : out.read.shapes)
        out.shapes.push_back(std::move(shape.shape));
    return out;
}

Faults bring(Request& what, const std::string& to, const CrsClaim& claim, std::size_t most = 100) {
    return bring_into(to, claim, what.shapes, what.read.shapes, most);
}

TEST(ShapeCrs, BringsEveryPositionOver) {
    Request what = request(R"({"type": "MultiPolygon", "coordinates": [
        [[[-84.12,36.34],[-84.11,36.34],[-84.11,36.35],[-84.12,36.34]]],
        [[[-84.22,36.34],[-84.21,36.34],[-84.21,36.35],[-84.22,36.34]]]]})");
    ASSERT_TRUE(bring(what, kUtm, {"EPSG:4326", ""}).empty());
    ASSERT_EQ(what.shapes[0].paths.size(), 2U);
    for (const core::Path& path : what.shapes[0].paths) {
        EXPECT_EQ(path.points.size(), 3U) << "the last is still not repeated";
        for (const core::Point2 p : path.points) {
            EXPECT_NEAR(p.x, 754000, 6000);
            EXPECT_NEAR(p.y, 4026000, 1000);
        }
    }
}

TEST(ShapeCrs, LeavesAloneWhatIsThereAlready) {
    for (const CrsClaim& claim : {CrsClaim{}, CrsClaim{kUtm, ""}, CrsClaim{kUtm, "/crs", true}}) {
        Request what = request(R"({"type": "Point", "coordinates": [0.1, 0.2]})");
        EXPECT_TRUE(bring(what, kUtm, claim).empty());
        EXPECT_EQ(what.shapes[0].paths[0].points[0], (core::Point2{0.1, 0.2}));
    }
    Request what = request(R"({"type": "Point", "coordinates": [0.1, 0.2]})");
    EXPECT_TRUE(bring(what, "EPSG:4326", {"OGC:CRS84", ""}).empty()) << "one system, two names";
}

TEST(ShapeCrs, TellsEachPositionWithoutAPlace) {
    Request what = request(R"({"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": {"type": "LineString",
            "coordinates": [[-84.1,36.3],[36.3,-84.1],[757400,4026300]]}},
        {"type": "Feature", "geometry": {"type": "MultiPoint", "coordinates": [[-84,36],[0,0]]}}]})");
    const Faults faults = bring(what, kUtm, {"EPSG:4326", ""});
    ASSERT_EQ(faults.size(), 3U);
    EXPECT_EQ(faults[0].code, "CRS_OUT_OF_AREA");
    EXPECT_EQ(faults[0].pointer, "/features/0/geometry/coordinates/1");
    EXPECT_EQ(faults[0].coordinate, (std::array{36.3, -84.1})) << "as the caller wrote it";
    EXPECT_EQ(faults[1].code, "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(faults[1].pointer, "/features/0/geometry/coordinates/2");
    EXPECT_EQ(faults[2].pointer, "/features/1/geometry/coordinates/1");
    Request again = request(R"({"type": "MultiPoint", "coordinates": [[0,0],[1,1],[2,2]]})");
    EXPECT_EQ(bring(again, kUtm, {"EPSG:4326", ""}, 2).size(), 2U);
}

TEST(ShapeCrs, WhatCannotBeUnderstoodIsRefusedWhereItIsSaid) {
    const auto refused = [](const std::string& to, const CrsClaim& claim) {
        Request what = request(R"({"type": "Point", "coordinates": [1, 2, 3]})");
        const Faults faults = bring(what, to, claim);
        if (faults.size() != 1) return std::string("taken");
        return faults[0].code + " " + faults[0].pointer + " " + faults[0].parameter;
    };
    EXPECT_EQ(refused("", {"EPSG:4326", "/crs"}), "CRS_MISMATCH /crs ");
    EXPECT_EQ(refused("", {"EPSG:4326", ""}), "CRS_MISMATCH  crs");
    EXPECT_EQ(refused(kUtm, {"EPSG:999999", "/tinsmith/crs"}), "CRS_UNKNOWN /tinsmith/crs ");
    EXPECT_EQ(refused(kUtm, {"EPSG:5703", ""}), "CRS_UNFIT  crs");
    EXPECT_EQ(refused(kUtm, {"EPSG:4979", "", true}), "CRS_VERTICAL  crs");
    EXPECT_EQ(refused(kUtm, {"EPSG:4979", "", false}), "CRS_TRANSFORM /coordinates ")
        << "in plan alone it is as good as any other";
}

TEST(ShapeCrs, ElevationsStayTheNumbersTheyAre) {
    Request what = request(R"({"type": "Point", "coordinates": [-84.1, 36.3, 312.5]})");
    ASSERT_TRUE(bring(what, kUtm, {"EPSG:4326", "", true}).empty());
    EXPECT_EQ(what.shapes[0].paths[0].elevations.at(0), 312.5);
}

TEST(ShapeCrs, BarePositionsHaveAnIndex) {
    std::vector<core::Point2> points{{-84.1, 36.3}, {-84.1, 91}};
    const Faults faults = bring_into(kUtm, {"EPSG:4326", ""}, points, "/points", 100);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].pointer, "/points/1");
}

TEST(GeoJson, ReadsTheSystemOfJsonFg) {
    const auto claim = [](const std::string& members) {
        const auto read =
            read_geojson(R"({"type": "Point", "coordinates": [1, 2], )" + members + "}", {});
        if (read) return read->crs + " " + read->crs_pointer;
        return read.faults()[0].code + " " + read.faults()[0].pointer;
    };
    EXPECT_EQ(claim(R"("coordRefSys": "http://www.opengis.net/def/crs/EPSG/0/25832")"),
              "EPSG:25832 /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": "[EPSG:25832]")"), "EPSG:25832 /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": {"type": "Reference",
                       "href": "http://www.opengis.net/def/crs/EPSG/0/25832", "epoch": 2010})"),
              "EPSG:25832 /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": null)"), " /crs");
    EXPECT_EQ(claim(R"("coordRefSys": "here")"), "CRS_UNKNOWN /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": {"type": "PROJJSON", "href": "x"})"),
              "CRS_UNKNOWN /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": ["[EPSG:25832]", "[EPSG:5783]"])"),
              "WRONG_TYPE /coordRefSys");
    const std::string legacy =
        R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}, )";
    EXPECT_EQ(claim(legacy + R"("coordRefSys": "[EPSG:25832]")"), "CONTRADICTION /coordRefSys");
    EXPECT_EQ(claim(legacy + R"("coordRefSys": "[EPSG:4326]")"), "EPSG:4326 /coordRefSys");
    EXPECT_EQ(claim(R"("place": {"type": "Point", "coordinates": [3, 4]})"), " /crs")
        << "a foreign member where nothing says JSON-FG";
    EXPECT_EQ(claim(R"("coordRefSys": "[EPSG:25832]", "place": null)"), "EPSG:25832 /coordRefSys");
    EXPECT_EQ(claim(R"("coordRefSys": "[EPSG:25832]",
                       "place": {"type": "Point", "coordinates": [3, 4]})"),
              "PLACE_UNSUPPORTED /coordRefSys");
    const auto nested = read_geojson(
        R"({"type": "FeatureCollection", "coordRefSys": "[EPSG:25832]", "features": [
            {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2]},
             "place": {"type": "Point", "coordinates": [3, 4]}}]})",
        {});
    ASSERT_FALSE(nested.ok());
    EXPECT_EQ(nested.faults()[0].code, "PLACE_UNSUPPORTED");
}

}  // namespace
}  // namespace tinsmith::api
