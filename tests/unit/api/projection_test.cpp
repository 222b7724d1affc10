// SPDX-License-Identifier: Apache-2.0
#include "api/projection.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

using core::Point2;

Transformation between(const std::string& from, const std::string& to) {
    auto made = Transformation::between(from, to);
    if (const auto* no = std::get_if<NoPlace>(&made)) throw std::runtime_error(no->detail);
    return std::get<Transformation>(std::move(made));
}

Point2 moved(const Transformation& transformation, Point2 p) {
    const auto there = transformation(p);
    if (const auto* no = std::get_if<NoPlace>(&there)) {
        ADD_FAILURE() << no->detail;
        return {};
    }
    return std::get<Point2>(there);
}

NoPlace refusal(const Transformation& transformation, Point2 p) {
    const auto there = transformation(p);
    if (const auto* no = std::get_if<NoPlace>(&there)) return *no;
    ADD_FAILURE() << "it has a place";
    return {};
}

TEST(Projection, TellsWhatASystemIs) {
    const auto utm = find_crs("EPSG:32616");
    ASSERT_TRUE(utm);
    EXPECT_EQ(utm->kind, CrsFacts::Kind::Projected);
    EXPECT_EQ(crs_with_name(*utm), "EPSG:32616 (WGS 84 / UTM zone 16N)");
    EXPECT_EQ(utm->metres, 1.0);
    EXPECT_FALSE(utm->has_height);
    const auto long_island = find_crs("EPSG:2263");
    ASSERT_TRUE(long_island);
    EXPECT_NEAR(long_island->metres, 1200.0 / 3937.0, 1e-15);
    const auto degrees = find_crs("EPSG:4326");
    ASSERT_TRUE(degrees);
    EXPECT_EQ(degrees->kind, CrsFacts::Kind::Geographic);
    EXPECT_EQ(degrees->unit_name, "degree");
    EXPECT_TRUE(find_crs("EPSG:4979")->has_height);
    const auto compound = find_crs("EPSG:5555");
    ASSERT_TRUE(compound);
    EXPECT_TRUE(compound->has_height);
    EXPECT_EQ(compound->kind, CrsFacts::Kind::Projected) << "of its plan part";
    EXPECT_EQ(find_crs("EPSG:5703")->kind, CrsFacts::Kind::Other) << "heights alone";
    EXPECT_EQ(find_crs("EPSG:4978")->kind, CrsFacts::Kind::Other) << "geocentric";
    for (const char* unknown : {"EPSG:999999", "NOBODY:1", "EPSG", ""})
        EXPECT_FALSE(find_crs(unknown)) << unknown;
}

TEST(Projection, EastingComesBeforeNorthingAndLongitudeBeforeLatitude) {
    // GDAL 3.6.2's ogr2ogr on the first corner of tests/data/lake.geojson.
    const Point2 in_degrees{-84.121783709533176, 36.346243696813737};
    for (const char* degrees : {"EPSG:4326", "OGC:CRS84", "EPSG:4979"}) {
        const Point2 there = moved(between(degrees, "EPSG:32616"), in_degrees);
        EXPECT_NEAR(there.x, 758300.706, 0.001) << degrees;
        EXPECT_NEAR(there.y, 4026200.0, 0.001) << degrees;
        const Point2 back = moved(between("EPSG:32616", degrees), there);
        EXPECT_NEAR(back.x, in_degrees.x, 1e-10) << degrees;
        EXPECT_NEAR(back.y, in_degrees.y, 1e-10) << degrees;
    }
    // EPSG names northing first for this one: Warsaw.
    const Point2 warsaw = moved(between("EPSG:4326", "EPSG:2180"), {21.0122, 52.2297});
    EXPECT_NEAR(warsaw.x, 637'382.20, 0.01);
    EXPECT_NEAR(warsaw.y, 486'757.21, 0.01);
}

TEST(Projection, SaysWhyAPositionHasNoPlace) {
    const Transformation to_utm = between("EPSG:4326", "EPSG:32616");
    const NoPlace metres = refusal(to_utm, {757400, 4026300});
    EXPECT_EQ(metres.code, "COORDINATE_OUT_OF_RANGE");
    EXPECT_NE(metres.detail.find("(757400, 4026300) is no longitude and latitude"),
              std::string::npos)
        << metres.detail;
    const NoPlace swapped = refusal(to_utm, {36.35, -84.12});
    EXPECT_EQ(swapped.code, "CRS_OUT_OF_AREA");
    EXPECT_NE(swapped.detail.find("(36.35, -84.12), as longitude and latitude in EPSG:4326"),
              std::string::npos)
        << swapped.detail;
    EXPECT_NE(swapped.detail.find("-90 to -84"), std::string::npos) << swapped.detail;
    EXPECT_EQ(refusal(between("EPSG:3857", "EPSG:32616"), {-84, 36}).code, "CRS_TRANSFORM");
    for (const double nothing : {std::nan(""), HUGE_VAL})
        EXPECT_FALSE(refusal(to_utm, {nothing, 36}).code.empty());
}

TEST(Projection, TakesTerrainsAcrossTheBorderOfAZone) {
    const Transformation to_utm = between("EPSG:4326", "EPSG:32616");
    EXPECT_GT(moved(to_utm, {-83.5, 36}).x, 800'000.0) << "half a degree outside";
    EXPECT_EQ(refusal(to_utm, {-78.5, 36}).code, "CRS_OUT_OF_AREA");
    // Fiji's zone lies on both sides of 180 degrees.
    const Transformation to_fiji = between("EPSG:4326", "EPSG:3460");
    EXPECT_LT(moved(to_fiji, {178, -18}).x, moved(to_fiji, {-179, -18}).x);
    EXPECT_EQ(refusal(to_fiji, {0, -18}).code, "CRS_OUT_OF_AREA");
}

TEST(Projection, SystemsThatCannotBeTakenAreNamed) {
    const auto no = [](const char* from, const char* to) {
        const auto made = Transformation::between(from, to);
        const auto* why = std::get_if<NoPlace>(&made);
        return why == nullptr ? std::string("none") : why->code + ": " + why->detail;
    };
    EXPECT_EQ(no("EPSG:32616", "EPSG:999999").substr(0, 24), "CRS_UNKNOWN: EPSG:999999");
    EXPECT_EQ(no("EPSG:5703", "EPSG:32616").substr(0, 21), "CRS_UNFIT: EPSG:5703 ");
    // Mars is no place on Earth.
    EXPECT_EQ(no("EPSG:32616", "IAU_2015:49900").substr(0, 21), "CRS_NO_TRANSFORMATION");
}

TEST(Projection, ChoosesTheZoneOfUtm) {
    const auto zone = [](const char* from, Point2 at) {
        const auto found = utm_zone_at(from, at);
        const auto* no = std::get_if<NoPlace>(&found);
        return no != nullptr ? no->code : std::get<std::string>(found);
    };
    EXPECT_EQ(zone("EPSG:4326", {-84.12, 36.35}), "EPSG:32616");
    EXPECT_EQ(zone("EPSG:4269", {-84.12, 36.35}), "EPSG:32616");
    EXPECT_EQ(zone("EPSG:4326", {-84.0, 0.0}), "EPSG:32617") << "a border belongs to the east";
    EXPECT_EQ(zone("EPSG:4326", {174.8, -41.3}), "EPSG:32760");
    EXPECT_EQ(zone("EPSG:4326", {180.0, 1.0}), "EPSG:32601");
    EXPECT_EQ(zone("EPSG:4326", {275.88, 36.35}), "EPSG:32616") << "longitudes from 0 to 360";
    EXPECT_EQ(zone("EPSG:4807", {0.0, 54.0}), "EPSG:32631") << "grads from Paris";
    EXPECT_EQ(zone("EPSG:4326", {0.0, 84.5}), "PROJECT_POLAR");
    EXPECT_EQ(zone("EPSG:4326", {0.0, -81.0}), "PROJECT_POLAR");
}

TEST(Projection, SeveralThreadsAtOnce) {
    const Point2 alone = moved(between("EPSG:4326", "EPSG:2154"), {2.35, 48.85});
    std::vector<Point2> found(4);
    std::vector<std::thread> threads;
    for (Point2& each : found) {
        threads.emplace_back([&each] {
            each = moved(between("EPSG:4326", "EPSG:2154"), {2.35, 48.85});
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    for (const Point2 each : found)
        EXPECT_EQ(each, alone);
}

}  // namespace
}  // namespace tinsmith::api
