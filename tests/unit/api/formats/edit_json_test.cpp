// SPDX-License-Identifier: Apache-2.0
#include "api/formats/edit_json.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

Parsed<EditRequest> read(const std::string& body) {
    return read_edit_request(body, ReadLimits{});
}

/// "CODE at pointer" of each fault.
std::string faults(const std::string& body) {
    auto read_body = read(body);
    if (read_body) return "";
    std::string text;
    for (const Fault& fault : read_body.faults())
        text += (text.empty() ? "" : ", ") + fault.code + " " + fault.pointer;
    return text;
}

TEST(EditJson, ReadsEachOperation) {
    const auto set = read(R"({"operation": "set", "polygon": "p3", "elevation": 412.5})");
    ASSERT_TRUE(set.ok());
    EXPECT_EQ(set->operation, EditKind::Set);
    EXPECT_EQ(set->polygon, "p3");
    EXPECT_EQ(set->plane.elevation({7, 8}), 412.5);
    EXPECT_FALSE(set->moves_border);
    EXPECT_EQ(set->rim, kDefaultRim);
    const auto plane = read(
        R"({"operation": "set", "polygon": "p", "plane": [[0,0,1],[1,0,2],[0,1,4]], "taper": 3})");
    ASSERT_TRUE(plane.ok());
    EXPECT_EQ(plane->plane.elevation({2, 2}), 9.0);
    EXPECT_TRUE(plane->moves_border);
    EXPECT_EQ(plane->taper, 3.0);
    EXPECT_FALSE(plane->rim);
    const auto slope = read(R"({"operation": "set", "polygon": "p", "slope": 0.5, "azimuth": 90,
        "point": [10, 0, 3], "border": "new"})");
    ASSERT_TRUE(slope.ok());
    EXPECT_EQ(slope->plane.elevation({12, 7}), 4.0);
    EXPECT_TRUE(slope->moves_border);
    EXPECT_FALSE(slope->rim);
    EXPECT_EQ(read(R"({"operation": "offset", "polygon": "p", "by": -2, "rim": 0.5})")->by, -2.0);
    const auto smooth = read(R"({"operation": "smooth", "polygon": "p", "passes": 3})");
    ASSERT_TRUE(smooth.ok());
    EXPECT_EQ(smooth->passes, 3U);
    EXPECT_FALSE(smooth->rim);
    EXPECT_TRUE(read(R"({"operation": "remove", "polygon": "p"})").ok());
    EXPECT_EQ(read(R"({"operation": "keep", "polygon": "p"})")->operation, EditKind::Keep);
    EXPECT_TRUE(read(R"({"operation": "offset", "polygon": "p", "by": 1, "border": "new",
                         "taper": 2})")
                    .ok());
}

TEST(EditJson, NamesEveryFault) {
    EXPECT_EQ(faults("{}"), "MEMBER_MISSING , MEMBER_MISSING ");
    EXPECT_EQ(faults(R"({"operation": "dig", "polygon": 3, "depth": 1})"),
              "WRONG_TYPE /polygon, MEMBER_UNKNOWN /depth, UNKNOWN_OPERATION /operation");
    EXPECT_EQ(faults(R"({"operation": "set", "polygon": "p"})"), "MEMBER_MISSING ");
    EXPECT_EQ(faults(R"({"operation": "set", "polygon": "p", "elevation": 1, "slope": 2})"),
              "CONTRADICTION , MEMBER_MISSING , MEMBER_MISSING ");
    EXPECT_EQ(faults(R"({"operation": "set", "polygon": "p",
                         "plane": [[0,0,1],[1,1,2],[2,2,4]]})"),
              "PLANE_UPRIGHT /plane");
    EXPECT_EQ(faults(R"({"operation": "offset", "polygon": "p", "passes": 2})"),
              "CONTRADICTION /passes, MEMBER_MISSING ");
    EXPECT_EQ(faults(R"({"operation": "smooth", "polygon": "p", "passes": 0, "rim": 1})"),
              "NUMBER_OUT_OF_RANGE /passes, CONTRADICTION /rim");
    EXPECT_EQ(faults(R"({"operation": "smooth", "polygon": "p", "passes": 1.5})"),
              "NUMBER_OUT_OF_RANGE /passes");
    EXPECT_EQ(faults(R"({"operation": "remove", "polygon": "p", "border": "old", "rim": 1,
                         "taper": 2})"),
              "CONTRADICTION /border, CONTRADICTION /rim, CONTRADICTION /taper");
    EXPECT_EQ(faults(R"({"operation": "keep", "polygon": "", "by": 1})"),
              "TEXT_EMPTY /polygon, CONTRADICTION /by");
}

TEST(EditJson, RefusesBordersThatContradict) {
    const auto offset = [](const std::string& rest) {
        return faults(R"({"operation": "offset", "polygon": "p", "by": 1, )" + rest + "}");
    };
    EXPECT_EQ(offset(R"("rim": 1, "taper": 1)"), "CONTRADICTION /rim");
    EXPECT_EQ(offset(R"("rim": 1, "border": "new")"), "CONTRADICTION /rim");
    EXPECT_EQ(offset(R"("taper": 1, "border": "old")"), "CONTRADICTION /border");
    EXPECT_EQ(offset(R"("border": "both")"), "INVALID_VALUE /border");
    EXPECT_EQ(offset(R"("rim": 0)"), "NUMBER_OUT_OF_RANGE /rim");
    EXPECT_EQ(offset(R"("taper": -1)"), "NUMBER_OUT_OF_RANGE /taper");
    EXPECT_EQ(offset(R"("taper": 1e300)"), "NUMBER_OUT_OF_RANGE /taper");
    EXPECT_EQ(offset(R"("rim": "wide")"), "WRONG_TYPE /rim");
    EXPECT_EQ(offset(R"("rim": 1, "border": "old")"), "");
}

}  // namespace
}  // namespace tinsmith::api
