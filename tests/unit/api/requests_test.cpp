// SPDX-License-Identifier: Apache-2.0
#include "api/requests.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

Parsed<PolygonOptions> polygon_options(const std::vector<NamedOption>& options) {
    return parse_polygon_options(options);
}

/// The code of the first fault, or "ok".
std::string fault_of(const std::string& name, const std::string& value) {
    const auto parsed = polygon_options({{name, value, ""}});
    return parsed ? "ok" : parsed.faults().front().code;
}

TEST(PolygonOptions, HaveTheAgreedDefaults) {
    const auto parsed = polygon_options({});
    ASSERT_TRUE(parsed);
    EXPECT_FALSE(parsed->own_elevations);
    EXPECT_EQ(parsed->integrate.on_crossing, core::OnCrossing::New);
    EXPECT_EQ(parsed->integrate.improve, core::Improve::Strict);
    EXPECT_EQ(parsed->integrate.snap, 0.0);
    EXPECT_EQ(parsed->integrate.outside, core::Outside::Skip);
    EXPECT_FALSE(parsed->integrate.lock);
    EXPECT_EQ(parsed->winding, core::Winding::EvenOdd);
    EXPECT_FALSE(parsed->dry_run);
    EXPECT_EQ(parsed->crs, "");
}

TEST(PolygonOptions, AreReadByName) {
    const auto parsed = polygon_options({{"improve", "bounded", ""},
                                         {"max_deviation", "0.125", ""},
                                         {"outside", "reject", ""},
                                         {"dry_run", "true", ""},
                                         {"angles", "true", ""},
                                         {"crs", "urn:ogc:def:crs:EPSG::32616", ""},
                                         {"elevation", "own", ""},
                                         {"on_crossing", "old", ""},
                                         {"winding", "nonzero", ""},
                                         {"lock", "true", ""},
                                         {"snap", "2.5E-1", ""}});
    ASSERT_TRUE(parsed);
    EXPECT_TRUE(parsed->own_elevations);
    EXPECT_EQ(parsed->integrate.on_crossing, core::OnCrossing::Old);
    EXPECT_EQ(parsed->integrate.improve, core::Improve::Bounded);
    EXPECT_EQ(parsed->integrate.max_deviation, 0.125);
    EXPECT_EQ(parsed->integrate.outside, core::Outside::Reject);
    EXPECT_EQ(parsed->integrate.snap, 0.25);
    EXPECT_TRUE(parsed->integrate.lock);
    EXPECT_EQ(parsed->winding, core::Winding::NonZero);
    EXPECT_TRUE(parsed->dry_run);
    EXPECT_TRUE(parsed->angles);
    EXPECT_EQ(parsed->crs, "EPSG:32616");
}

TEST(PolygonOptions, KnowEveryImprovement) {
    EXPECT_EQ(polygon_options({{"improve", "none", ""}})->integrate.improve, core::Improve::None);
    EXPECT_EQ(polygon_options({{"improve", "paper", ""}})->integrate.improve, core::Improve::Paper);
}

TEST(PolygonOptions, RefuseValuesThatCannotBe) {
    for (const auto& [name, value] :
         std::vector<std::pair<std::string, std::string>>{{"elevation", "up"},
                                                          {"on_crossing", "both"},
                                                          {"improve", "Strict"},
                                                          {"max_deviation", "0"},
                                                          {"max_deviation", "-1"},
                                                          {"max_deviation", "inf"},
                                                          {"snap", "-1"},
                                                          {"snap", "nan"},
                                                          {"snap", "1e999"},
                                                          {"snap", "1x"},
                                                          {"snap", ""},
                                                          {"winding", ""},
                                                          {"lock", "yes"},
                                                          {"dry_run", "1"},
                                                          {"angles", "yes"},
                                                          {"outside", "clip"},
                                                          {"crs", "somewhere"}}) {
        EXPECT_EQ(fault_of(name, value), "INVALID_OPTION") << name << "=" << value;
    }
    EXPECT_EQ(fault_of("colour", "red"), "UNKNOWN_OPTION");
}

TEST(PolygonOptions, SayWhatToGiveInstead) {
    const auto parsed = polygon_options({{"improve", "best", ""}, {"winding", "x", ""}});
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.faults()[0].detail,
              "improve cannot be \"best\": give none, strict, paper or bounded.");
    EXPECT_EQ(parsed.faults()[1].detail, "winding cannot be \"x\": give evenodd or nonzero.");
}

TEST(PolygonOptions, NeedTheOtherHalf) {
    EXPECT_EQ(fault_of("improve", "bounded"), "OPTION_INCOMPLETE");
    EXPECT_EQ(fault_of("max_deviation", "1"), "OPTION_INCOMPLETE");
    EXPECT_EQ(fault_of("on_crossing", "new"), "OPTION_INCOMPLETE");
    const auto parsed = polygon_options({{"max_deviation", "1", "/tinsmith/max_deviation"},
                                         {"improve", "paper", ""},
                                         {"on_crossing", "old", ""},
                                         {"elevation", "drape", ""}});
    ASSERT_FALSE(parsed);
    ASSERT_EQ(parsed.faults().size(), 2U);
    EXPECT_EQ(parsed.faults()[0].pointer, "/tinsmith/max_deviation");
    EXPECT_EQ(parsed.faults()[0].parameter, "");
    EXPECT_EQ(parsed.faults()[0].detail.substr(0, 36), "max_deviation needs improve=bounded:");
    EXPECT_EQ(parsed.faults()[1].pointer, "");
    EXPECT_EQ(parsed.faults()[1].parameter, "on_crossing");
    EXPECT_EQ(parsed.faults()[1].detail.substr(0, 32), "on_crossing needs elevation=own,");
}

TEST(PolygonOptions, MayFindTheirOtherHalfLater) {
    const std::vector<NamedOption> part{{"on_crossing", "old", ""}, {"snap", "-1", ""}};
    const auto parsed = parse_polygon_options(part, OptionList::Part);
    ASSERT_FALSE(parsed);
    ASSERT_EQ(parsed.faults().size(), 1U);
    EXPECT_EQ(parsed.faults()[0].parameter, "snap");
}

TEST(PolygonOptions, BlameNoOptionForItsRefusedPartner) {
    const auto parsed = polygon_options({{"on_crossing", "old", ""},
                                         {"elevation", "mine", ""},
                                         {"max_deviation", "1", ""},
                                         {"improve", "best", ""}});
    ASSERT_FALSE(parsed);
    ASSERT_EQ(parsed.faults().size(), 2U);
    EXPECT_EQ(parsed.faults()[0].parameter, "elevation");
    EXPECT_EQ(parsed.faults()[1].parameter, "improve");
}

TEST(PolygonOptions, NameAllFaultsAtOnce) {
    const auto parsed = polygon_options(
        {{"colour", "red", "/tinsmith/colour"}, {"lock", "1", ""}, {"snap", "x", ""}});
    ASSERT_FALSE(parsed);
    ASSERT_EQ(parsed.faults().size(), 3U);
    EXPECT_EQ(parsed.kind(), FaultKind::Invalid);
    EXPECT_EQ(parsed.faults()[0].pointer, "/tinsmith/colour");
    EXPECT_NE(parsed.faults()[0].detail.find("improve"), std::string::npos);
}

TEST(PolygonOptions, MayBeGivenTwiceIfTheyAgree) {
    EXPECT_TRUE(
        polygon_options({{"improve", "none", ""}, {"improve", "none", "/tinsmith/improve"}}));
    EXPECT_TRUE(polygon_options({{"snap", "0.5", ""}, {"snap", "5.0e-1", "/tinsmith/snap"}}));
    EXPECT_TRUE(polygon_options(
        {{"crs", "EPSG:32616", ""}, {"crs", "urn:ogc:def:crs:EPSG::32616", "/tinsmith/crs"}}));
    const auto parsed =
        polygon_options({{"improve", "none", ""}, {"improve", "strict", "/tinsmith/improve"}});
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.faults().front().code, "CONTRADICTION");
}

TEST(Options, AllSayWhatTheyTake) {
    for (const std::string_view name : polygon_option_names())
        EXPECT_NE(option_values(name), "") << name;
    for (const std::string_view name : mesh_option_names())
        EXPECT_NE(option_values(name), "") << name;
    EXPECT_EQ(option_values("colour"), "");
}

TEST(MeshOptions, AreReadByName) {
    const auto defaults = parse_mesh_options({});
    ASSERT_TRUE(defaults);
    EXPECT_EQ(defaults->gltf.compression, Compression::Draco);
    EXPECT_EQ(defaults->gltf.tolerance, 0.005);
    const std::vector<NamedOption> options{{"compression", "none", ""},
                                           {"tolerance", "0.25", ""},
                                           {"up", "z", ""},
                                           {"constraints", "false", ""},
                                           {"normals", "false", ""}};
    const auto parsed = parse_mesh_options(options);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->gltf.compression, Compression::None);
    EXPECT_EQ(parsed->gltf.tolerance, 0.25);
    EXPECT_EQ(parsed->gltf.up, UpAxis::Z);
    EXPECT_FALSE(parsed->gltf.constraints);
    EXPECT_FALSE(parsed->gltf.normals);
}

TEST(MeshOptions, RefuseTolerancesThatAreNone) {
    for (const char* value : {"0", "-1", "nan", "inf", "1e999", "", "1 ", "1001", "0x1"}) {
        const std::vector<NamedOption> options{{"tolerance", value, ""}};
        const auto parsed = parse_mesh_options(options);
        ASSERT_FALSE(parsed) << value;
        EXPECT_EQ(parsed.kind(), FaultKind::Parameter) << "the body is not at fault";
    }
    const std::vector<NamedOption> later{{"version", "3", ""}};
    const auto parsed = parse_mesh_options(later);
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.kind(), FaultKind::Unsupported);
    EXPECT_EQ(parsed.faults().size(), 1U);
}

TEST(MeshOptions, TakeABoxAndRegions) {
    const std::vector<NamedOption> options{
        {"compression", "meshopt", ""}, {"regions", "true", ""}, {"bbox", "-1.5,2,3e2,2", ""}};
    const auto parsed = parse_mesh_options(options);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->gltf.compression, Compression::Meshopt);
    EXPECT_TRUE(parsed->regions);
    ASSERT_TRUE(parsed->bbox);
    EXPECT_EQ(parsed->bbox->min_x, -1.5);
    EXPECT_EQ(parsed->bbox->min_y, 2.0);
    EXPECT_EQ(parsed->bbox->max_x, 300.0);
    EXPECT_EQ(parsed->bbox->max_y, 2.0);
    for (const char* value : {"", "1,2,3", "1,2,3,4,5", "1,2,3,", "3,2,1,4", "1,4,3,2", "1,2,3,nan",
                              "1, 2,3,4", "1;2;3;4", "1,2,3,1e16"}) {
        const std::vector<NamedOption> bad{{"bbox", value, ""}};
        EXPECT_FALSE(parse_mesh_options(bad)) << value;
    }
}

}  // namespace
}  // namespace tinsmith::api
