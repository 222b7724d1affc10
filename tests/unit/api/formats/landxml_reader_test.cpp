// SPDX-License-Identifier: Apache-2.0
#include "api/formats/landxml_reader.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"

namespace tinsmith::api {
namespace {

constexpr const char* kPoints =
    "<P id='a'>100 1 5</P>\n<P id='b'>100 2 6</P>\n<P id='c'>101 2 7</P>\n<P id='d'>101 1 8</P>\n";

std::string surface(const std::string& points, const std::string& faces,
                    const std::string& name = "S") {
    return "<Surface name='" + name + "'><Definition surfType='TIN'><Pnts>\n" + points +
           "</Pnts><Faces>\n" + faces + "</Faces></Definition></Surface>";
}

std::string file(const std::string& surfaces, const std::string& head = "") {
    return "<?xml version='1.0'?>\n<LandXML version='1.2'>" + head + "<Surfaces>" + surfaces +
           "</Surfaces></LandXML>";
}

std::string codes(const std::string& text, const ReadLimits& limits = {}) {
    const auto read = read_landxml(text, limits);
    if (read) return "";
    std::string out;
    for (const Fault& fault : read.faults())
        out += (out.empty() ? "" : " ") + fault.code;
    return out;
}

TEST(LandXml, ReadsNorthingEastingElevationAndTurnsFacesUp) {
    const auto read =
        read_landxml(file(surface(kPoints, "<F>a b c</F><F n='0 1 2'> d c\na </F>"),
                          "<Units><Imperial linearUnit='USSurveyFoot'/></Units><CoordinateSystem "
                          "epsgCode='2264'/>"),
                     {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices,
              (std::vector<core::Point3>{{1, 100, 5}, {2, 100, 6}, {2, 101, 7}, {1, 101, 8}}));
    EXPECT_EQ(read->mesh.triangles,
              (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 0, 2}}));
    EXPECT_EQ(read->unit, "US survey foot");
    EXPECT_TRUE(read->unit_is_said);
    EXPECT_EQ(read->crs, "EPSG:2264");
    EXPECT_EQ(read->vertex_place(3), "point \"d\"");
}

TEST(LandXml, KeepsNamesInUtf8WhateverTheBytesAre) {
    const auto name = [](const std::string& given) {
        return read_landxml(file(surface(kPoints, "<F>a b c</F>", given)), {})->name;
    };
    EXPECT_EQ(name("a\xC3\xA9z"), "a\xC3\xA9z");
    EXPECT_EQ(name("a\xFFz\xC3"), "a?z?");
    EXPECT_EQ(name("\xED\xA0\x80"), "???");  // half of a pair
    std::string longest(199, 'a');
    EXPECT_EQ(name(longest + "\xC3\xA9"), longest);
    EXPECT_EQ(name(longest + "bc"), longest + "b");
}

TEST(LandXml, LeavesInvisibleFacesAndTheirPointsOut) {
    const auto read = read_landxml(file(surface(kPoints, "<F i='1'>a b c</F><F>a c d</F>")), {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->mesh.vertices.size(), 3U);
    EXPECT_EQ(read->mesh.triangles.size(), 1U);
    EXPECT_EQ(read->triangle_place(0), "face 2");
    EXPECT_EQ(read->vertex_place(1), "point \"c\"");
    ASSERT_EQ(read->notes.size(), 1U);
    EXPECT_NE(read->notes[0].find("1 points"), std::string::npos);
}

TEST(LandXml, KnowsPrefixesAndPassesSourceDataOverWithANote) {
    std::string text = file(
        "<l:Surface name='x'><l:SourceData><l:Breaklines><l:Breakline/>"
        "</l:Breaklines></l:SourceData><l:Definition><l:Pnts>"
        "<l:P id='1'>0 0 0</l:P><l:P id='2'>0 1 0</l:P><l:P id='3'>1 0 0</l:P>"
        "</l:Pnts><l:Faces><l:F>1 2 3</l:F></l:Faces></l:Definition></l:Surface>");
    const auto read = read_landxml(text, {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->notes,
              std::vector<std::string>{"1 breaklines that do not run along edges of the faces were "
                                       "passed over."});
}

TEST(LandXml, TakesBreaklinesAlongEdgesAsConstraints) {
    const auto read_with = [](const std::string& breaklines) {
        return read_landxml(
            file("<Surface><SourceData><Breaklines>" + breaklines +
                 "</Breaklines><Contours><Contour/></Contours></SourceData><Definition><Pnts>"
                 "<P id='1'>0 0 0</P><P id='9'>5 5 5</P><P id='2'>0 1 0.1</P><P id='3'>1 1 0</P>"
                 "<P id='4'>1 0 7</P></Pnts><Faces><F>1 2 3</F><F>1 3 4</F></Faces></Definition>"
                 "</Surface>"),
            {});
    };
    const auto line = [](const std::string& places) {
        return "<Breakline><PntList3D>" + places + "</PntList3D></Breakline>";
    };
    const auto taken = read_with(line("0 0 0 1 1 0 1 0 7") + line("\n1 1 0\n0 1 1e-1\n"));
    ASSERT_TRUE(taken) << taken.faults().front().detail;
    EXPECT_EQ(taken->mesh.constraints,
              (std::vector<std::array<std::uint32_t, 2>>{{0, 2}, {2, 3}, {2, 1}}));
    EXPECT_EQ(taken->notes.size(), 2U) << "the unused point, the contours";
    EXPECT_TRUE(core::build_tin(taken->mesh));
    // Of a vertex only, beside one, along no edge, beyond the end, and what is no numbers.
    const std::string others[] = {line("0 0 0"),         line("0 0 0 0 1 0.2"),
                                  line("0 1 0.1 1 0 7"), line("0 0 0 1 1 0 2"),
                                  line("0 0 0 1 1 x"),   line("0 0 0 1 1 0 0 1 0.1 1 0 7")};
    for (const std::string& other : others) {
        const auto left = read_with(other + line("0 0 0 1 1 0"));
        ASSERT_TRUE(left) << left.faults().front().detail;
        EXPECT_EQ(left->mesh.constraints.size(), 1U) << other;
        ASSERT_EQ(left->notes.size(), 3U) << other;
        EXPECT_EQ(left->notes[1].substr(0, 13), "1 breaklines ");
    }
}

TEST(LandXml, WantsOneSurface) {
    const std::string one = surface(kPoints, "<F>a b c</F>", "ground");
    EXPECT_EQ(codes(file("")), "SURFACE_MISSING");
    const auto two = read_landxml(file(one + surface(kPoints, "<F>a b c</F>", "rock")), {});
    ASSERT_FALSE(two);
    EXPECT_EQ(two.faults()[0].code, "SURFACES");
    EXPECT_NE(two.faults()[0].detail.find("\"ground\", \"rock\""), std::string::npos);
    const auto grid = read_landxml(
        file(one + "<Surface><Definition surfType='grid'><Faces/></Definition></Surface>"), {});
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->notes.size(), 2U);  // one for the point that no face names
}

TEST(LandXml, NamesEachFaultByIdOrNumberAndLine) {
    EXPECT_EQ(
        codes(file(surface("<P id='1'>0 0</P><P id='1'>0 0 x</P><P>0 0 0</P><P id='2'>1 1 1</P>"
                           "<P id='2'>1 1 1</P><P id='3'>1 1 1 1</P><P id='4'>nan 1 1</P>",
                           ""))),
        "LANDXML_POINT LANDXML_POINT LANDXML_ID LANDXML_ID LANDXML_POINT "
        "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(codes(file(surface(kPoints, "<F>a b</F><F>a b z</F><F>a b c d</F>"))),
              "LANDXML_FACE LANDXML_FACE LANDXML_FACE");
    const auto read = read_landxml(file(surface(kPoints, "<F>a b c</F>\n<F>a b z</F>")), {});
    EXPECT_EQ(read.faults()[0].detail, "Face 2 (line 9) names point \"z\", which is not there.");
    EXPECT_EQ(codes(file("", "<Units><Metric linearUnit='parsec'/></Units>")),
              "UNIT_UNKNOWN SURFACE_MISSING");
}

TEST(LandXml, RefusesWhatIsNoLandXmlOrDefinesEntities) {
    EXPECT_EQ(codes(""), "XML_SYNTAX");
    EXPECT_EQ(codes("<LandXML><Surfaces>"), "XML_SYNTAX");
    EXPECT_EQ(codes("<gml/>"), "LANDXML_MISSING");
    EXPECT_EQ(codes("<!DOCTYPE x [<!ENTITY a 'b'><!ENTITY c '&a;&a;'>]>\n<LandXML/>"),
              "XML_DOCTYPE");
}

TEST(LandXml, StopsAtItsLimits) {
    const std::string text = file(surface(kPoints, "<F>a b c</F><F>a c d</F>"));
    ReadLimits limits;
    limits.max_vertices = 3;
    EXPECT_EQ(codes(text, limits), "TOO_MANY_VERTICES");
    limits = {};
    limits.max_triangles = 1;
    EXPECT_EQ(codes(text, limits), "TOO_MANY_TRIANGLES");
    std::string many = "<LandXML>";
    for (int i = 0; i < 1'100'000; ++i)
        many += "<Aaaaaaaa/>";
    limits.max_vertices = 1;
    limits.max_triangles = 1;
    EXPECT_EQ(codes(many + "</LandXML>", limits), "XML_TOO_LARGE");
    EXPECT_EQ(codes(many), "XML_SYNTAX");  // well below the usual limits
    std::string short_ones = "<LandXML>";  // shorter than points and faces can be
    for (int i = 0; i < 2'200'000; ++i)
        short_ones += "<a/>";
    EXPECT_EQ(codes(short_ones), "XML_TOO_LARGE");
}

}  // namespace
}  // namespace tinsmith::api
