// SPDX-License-Identifier: Apache-2.0
#include "api/requests.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

Parsed<PolygonOptions> polygon_options(const std::vector<NamedOption>& options) {
    return parse_polygon_options(options);
}

/// "kind:code" of the only fault, or what else came.
std::string fault_of(const std::string& name, const std::string& value) {
    const auto parsed = polygon_options({{name, value, ""}});
    if (parsed) return "ok";
    const std::string kind = parsed.kind() == FaultKind::Unsupported ? "later:" : "wrong:";
    return kind + parsed.faults().front().code;
}

TEST(PolygonOptions, HaveTheAgreedDefaults) {
    const auto parsed = polygon_options({});
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->improve, core::Improve::Strict);
    EXPECT_EQ(parsed->outside, core::Outside::Skip);
    EXPECT_FALSE(parsed->dry_run);
    EXPECT_EQ(parsed->crs, "");
}

TEST(PolygonOptions, AreReadByName) {
    const auto parsed = polygon_options({{"improve", "none", ""},
                                         {"outside", "reject", ""},
                                         {"dry_run", "true", ""},
                                         {"crs", "urn:ogc:def:crs:EPSG::32616", ""},
                                         {"elevation", "drape", ""},
                                         {"winding", "evenodd", ""},
                                         {"lock", "false", ""},
                                         {"snap", "0.0", ""}});
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->improve, core::Improve::None);
    EXPECT_EQ(parsed->outside, core::Outside::Reject);
    EXPECT_TRUE(parsed->dry_run);
    EXPECT_EQ(parsed->crs, "EPSG:32616");
}

TEST(PolygonOptions, TellWhatIsNotAvailableFromWhatIsWrong) {
    for (const auto& [name, value] :
         std::vector<std::pair<std::string, std::string>>{{"elevation", "own"},
                                                          {"improve", "paper"},
                                                          {"improve", "bounded"},
                                                          {"snap", "0.25"},
                                                          {"winding", "nonzero"},
                                                          {"lock", "true"},
                                                          {"max_deviation", "1"},
                                                          {"on_crossing", "new"}}) {
        EXPECT_EQ(fault_of(name, value), "later:NOT_AVAILABLE") << name << "=" << value;
    }
    for (const auto& [name, value] :
         std::vector<std::pair<std::string, std::string>>{{"elevation", "up"},
                                                          {"improve", "Strict"},
                                                          {"snap", "-1"},
                                                          {"snap", "nan"},
                                                          {"snap", "1x"},
                                                          {"snap", ""},
                                                          {"winding", ""},
                                                          {"lock", "yes"},
                                                          {"dry_run", "1"},
                                                          {"outside", "clip"},
                                                          {"crs", "somewhere"}}) {
        EXPECT_EQ(fault_of(name, value), "wrong:INVALID_OPTION") << name << "=" << value;
    }
    EXPECT_EQ(fault_of("colour", "red"), "wrong:UNKNOWN_OPTION");
}

TEST(PolygonOptions, NameAllFaultsAtOnce) {
    const auto parsed = polygon_options(
        {{"colour", "red", "/tinsmith/colour"}, {"lock", "true", ""}, {"snap", "x", ""}});
    ASSERT_FALSE(parsed);
    ASSERT_EQ(parsed.faults().size(), 3U);
    EXPECT_EQ(parsed.kind(), FaultKind::Invalid);
    EXPECT_EQ(parsed.faults()[0].pointer, "/tinsmith/colour");
    EXPECT_NE(parsed.faults()[0].detail.find("improve"), std::string::npos);
}

TEST(PolygonOptions, MayBeGivenTwiceIfTheyAgree) {
    EXPECT_TRUE(
        polygon_options({{"improve", "none", ""}, {"improve", "none", "/tinsmith/improve"}}));
    const auto parsed =
        polygon_options({{"improve", "none", ""}, {"improve", "strict", "/tinsmith/improve"}});
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.faults().front().code, "CONTRADICTION");
}

TEST(MeshOptions, AreReadByName) {
    const auto defaults = parse_mesh_options({});
    ASSERT_TRUE(defaults);
    EXPECT_EQ(defaults->compression, Compression::Draco);
    EXPECT_EQ(defaults->tolerance, 0.005);
    const std::vector<NamedOption> options{{"compression", "none", ""},
                                           {"tolerance", "0.25", ""},
                                           {"up", "z", ""},
                                           {"constraints", "false", ""},
                                           {"normals", "false", ""}};
    const auto parsed = parse_mesh_options(options);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->compression, Compression::None);
    EXPECT_EQ(parsed->tolerance, 0.25);
    EXPECT_EQ(parsed->up, UpAxis::Z);
    EXPECT_FALSE(parsed->constraints);
    EXPECT_FALSE(parsed->normals);
}

TEST(MeshOptions, RefuseTolerancesThatAreNone) {
    for (const char* value : {"0", "-1", "nan", "inf", "1e999", "", "1 ", "1001", "0x1"}) {
        const std::vector<NamedOption> options{{"tolerance", value, ""}};
        const auto parsed = parse_mesh_options(options);
        ASSERT_FALSE(parsed) << value;
        EXPECT_EQ(parsed.kind(), FaultKind::Parameter) << "the body is not at fault";
    }
    const std::vector<NamedOption> later{{"compression", "meshopt", ""}, {"version", "3", ""}};
    const auto parsed = parse_mesh_options(later);
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.kind(), FaultKind::Unsupported);
    EXPECT_EQ(parsed.faults().size(), 2U);
}

}  // namespace
}  // namespace tinsmith::api
