// SPDX-License-Identifier: Apache-2.0
#include "api/crs.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

TEST(Crs, OneSpelling) {
    EXPECT_EQ(normalise_crs("epsg:32616"), "EPSG:32616");
    EXPECT_EQ(normalise_crs("urn:ogc:def:crs:EPSG::32616"), "EPSG:32616");
    EXPECT_EQ(normalise_crs("urn:ogc:def:crs:EPSG:9.8:32616"), "EPSG:32616");
    EXPECT_EQ(normalise_crs("http://www.opengis.net/def/crs/EPSG/0/32616"), "EPSG:32616");
    EXPECT_EQ(normalise_crs("urn:ogc:def:crs:OGC:1.3:CRS84"), "OGC:CRS84");
    for (const char* bad : {"", "32616", "EPSG:", ":1", "EPSG::32616", "urn:ogc:def:crs:EPSG",
                            "a:b:c:d", "EPSG:32616+5703", "EPSG:3 2", "urn:ogc:def:crs:a:b:c:d"}) {
        EXPECT_EQ(normalise_crs(bad), std::nullopt) << bad;
    }
}

TEST(Crs, LongitudeFirstMakesTwoNamesOneSystem) {
    EXPECT_TRUE(same_crs("EPSG:4326", "OGC:CRS84"));
    EXPECT_TRUE(same_crs("OGC:CRS84", "EPSG:4326"));
    EXPECT_TRUE(same_crs("EPSG:32616", "EPSG:32616"));
    EXPECT_FALSE(same_crs("EPSG:4326", "OGC:CRS83"));
    EXPECT_FALSE(same_crs("EPSG:32616", "EPSG:32617"));
    EXPECT_FALSE(same_crs("EPSG:4326", ""));
}

TEST(Crs, Units) {
    EXPECT_EQ(normalise_unit("m"), "metre");
    EXPECT_EQ(normalise_unit("Meter"), "metre");
    EXPECT_EQ(normalise_unit("us_survey_foot"), "US survey foot");
    EXPECT_EQ(normalise_unit("ft"), "foot");
    EXPECT_EQ(unit_of_length(0.3048), "foot");
    EXPECT_EQ(unit_of_length(1200.0 / 3937.0), "US survey foot");
    EXPECT_EQ(unit_of_length(0.3047972654), std::nullopt) << "Clarke's foot";
    EXPECT_EQ(normalise_unit("degree"), std::nullopt);
    EXPECT_EQ(metres_per("metre"), 1.0);
    EXPECT_EQ(metres_per("foot"), 0.3048);
    EXPECT_NEAR(metres_per("US survey foot"), 0.304800609601, 1e-12);
}

}  // namespace
}  // namespace tinsmith::api
