// SPDX-License-Identifier: Apache-2.0
#include "api/formats/obj_reader.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr const char* kCorners = "v 0 0 0\nv 4 0 1\nv 4 4 2\nv 0 4 3\n";

std::string codes(const std::string& text, const ReadLimits& limits = {}) {
    const auto read = read_obj(text, limits);
    if (read) return "";
    std::string out;
    for (const Fault& fault : read.faults())
        out += (out.empty() ? "" : " ") + fault.code;
    return out;
}

std::string first_detail(const std::string& text) {
    const auto read = read_obj(text, {});
    return read ? "" : read.faults().front().detail;
}

TEST(Obj, ReadsFacesInAllTheirSpellings) {
    const auto read = read_obj(
        "# a comment\r\nmtllib a.mtl\r\no thing\nv 0 0 0\nv\t4 +0.0e0 1 1 0 0\nv 4 4 \\\n2\nv 0 4 "
        "3 1.0\n"
        "vt 0 0\nvn 0 0 1\ng a b\nusemtl m\ns off\nf 1 2/1 3/1/1\nf 1//1 -2 -1 # a comment\n",
        {});
    ASSERT_TRUE(read) << read.faults().front().detail;
    EXPECT_EQ(read->mesh.vertices,
              (std::vector<core::Point3>{{0, 0, 0}, {4, 0, 1}, {4, 4, 2}, {0, 4, 3}}));
    EXPECT_EQ(read->mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(read->triangle_place(1), "line 15");
    EXPECT_EQ(read->vertex_place(3), "line 8");
    EXPECT_FALSE(read->unit_is_said);
}

TEST(Obj, ReadsDoublesExactly) {
    const auto read = read_obj("v 757400.123456789 4026300.1 1e-3\nv 2 0 0\nv 0 2 0\nf 1 2 3", {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->mesh.vertices[0], (core::Point3{757400.123456789, 4026300.1, 1e-3}));
}

TEST(Obj, CutsFacesAboutACornerThatSeesAllOthers) {
    EXPECT_EQ(read_obj(std::string(kCorners) + "f 1 2 3 4", {})->mesh.triangles,
              (Triangles{{0, 1, 2}, {0, 2, 3}}));
    // An arrow's head: from its notch or its tip only.
    EXPECT_EQ(read_obj("v 4 4 0\nv 0 3 0\nv 3 3 0\nv 3 0 0\nf 4 1 2 3", {})->mesh.triangles,
              (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(codes("v 0 0 0\nv 9 0 0\nv 9 3 0\nv 6 3 0\nv 6 1 0\nv 3 1 0\nv 3 3 0\nv 0 3 0\nf 1 2 "
                    "3 4 5 6 7 8"),
              "OBJ_POLYGON");
    // Upright: without area from every corner, so as it is, for the builder to name or to mend.
    EXPECT_EQ(read_obj("v 0 0 0\nv 4 0 0\nv 4 0 9\nv 0 0 9\nf 1 2 3 4", {})->mesh.triangles,
              (Triangles{{0, 1, 2}, {0, 2, 3}}));
    // The other way round: as it is, for the builder to name.
    EXPECT_EQ(read_obj(std::string(kCorners) + "f 4 3 2 1", {})->mesh.triangles,
              (Triangles{{3, 2, 1}, {3, 1, 0}}));
}

TEST(Obj, PassesLinesOverWithANoteAndTakesItsOwnAsConstraints) {
    const std::string text = std::string(kCorners) + "f 1 2 3\nf 1 3 4\nl 1 2 3\np 1\n";
    const auto read = read_obj(text, {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->notes.size(), 1U);
    EXPECT_TRUE(read->mesh.constraints.empty());
    EXPECT_EQ(read_obj("# tinsmith\n" + text, {})->mesh.constraints,
              (std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {1, 2}}));
}

TEST(Obj, NamesEachFaultByItsLine) {
    EXPECT_EQ(codes("v 1 2\nv a 2 3\nv nan 0 0\nv 1e300 0 0\nw 1\nsurf 0 1\nf 0 1 9\nf 1 2\n"),
              "OBJ_VERTEX OBJ_VERTEX COORDINATE_OUT_OF_RANGE COORDINATE_OUT_OF_RANGE OBJ_KEYWORD "
              "OBJ_FREE_FORM OBJ_INDEX OBJ_INDEX OBJ_FACE");
    EXPECT_EQ(first_detail("\n\nv 1 \\\n x 3\n"), "Line 3: \"x\" is no number.");
    EXPECT_EQ(first_detail("v 0 0 0\nf 1 -2 1"),
              "Line 2: \"-2\" names a vertex that is not there: 1 were given by then.");
    EXPECT_EQ(codes(""), "OBJ_EMPTY");
    EXPECT_EQ(first_detail("\xff\xfe"), "Line 1: \"??\" begins no statement of an OBJ.");
}

TEST(Obj, StopsAtItsLimits) {
    ReadLimits limits;
    limits.max_vertices = 3;
    EXPECT_EQ(codes(kCorners, limits), "TOO_MANY_VERTICES");
    limits = {};
    limits.max_triangles = 1;
    EXPECT_EQ(codes(std::string(kCorners) + "f 1 2 3 4", limits), "TOO_MANY_TRIANGLES");
    limits = {};
    limits.max_faults = 2;
    EXPECT_EQ(codes("a\nb\nc\n", limits), "OBJ_KEYWORD OBJ_KEYWORD");
    limits.progress = [](double) { return false; };
    EXPECT_EQ(codes(kCorners, limits), "STOPPED");
}

}  // namespace
}  // namespace tinsmith::api
