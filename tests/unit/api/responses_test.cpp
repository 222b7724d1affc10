// SPDX-License-Identifier: Apache-2.0
#include "api/responses.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tinsmith::api {
namespace {

using nlohmann::json;

SessionView view_of(std::string id) {
    return {std::move(id),
            "Ridge",
            "EPSG:32616",
            "metre",
            3,
            138632,
            275772,
            {{1.5, 2, 3}, {4, 5, 6}},
            2,
            17000000};
}

TEST(WriteSession, HasTheAgreedShape) {
    EXPECT_EQ(json::parse(write_session(view_of("a"))), json::parse(R"({
        "id": "a", "name": "Ridge", "crs": "EPSG:32616", "unit": "metre", "version": 3,
        "vertices": 138632, "triangles": 275772, "bounds": [1.5, 2.0, 3.0, 4.0, 5.0, 6.0],
        "polygons": 2, "memory_bytes": 17000000})"));
}

TEST(WriteSession, WritesNullForAnUnknownSystem) {
    SessionView view = view_of("a");
    view.crs.clear();
    EXPECT_TRUE(json::parse(write_session(view))["crs"].is_null());
}

TEST(WriteSession, SurvivesNamesThatAreNotUtf8) {
    SessionView view = view_of("a");
    view.name = "\xff\"";
    EXPECT_TRUE(json::accept(write_session(view)));
}

TEST(WriteSessionList, IsAnObjectWithAList) {
    EXPECT_EQ(json::parse(write_session_list({})), json::parse(R"({"sessions": []})"));
    const std::array views{view_of("a"), view_of("b")};
    const auto body = json::parse(write_session_list(views));
    ASSERT_EQ(body["sessions"].size(), 2U);
    EXPECT_EQ(body["sessions"][1]["id"], "b");
}

TEST(WriteReport, HasTheAgreedShape) {
    core::Report report;
    report.shapes.resize(2);
    report.shapes[0] = {
        91, 2550, 2640, 5280, 900, {}, {}, 0.0, 0.125, 7.5, {31.25, 0.5, 35.0, 2.0}};
    report.shapes[1].segments = 1;
    report.shapes[1].outside.push_back({2, {{1.5, 2}, {3, 4}}});
    report.time_ms = {0.25, 0.5, 0.75};
    const std::array<std::string, 2> ids{"p4", "p5"};
    const auto body = json::parse(write_report({"s", 4, true, ids, report}));
    EXPECT_EQ(body["session"], "s");
    EXPECT_EQ(body["version"], 4);
    EXPECT_EQ(body["dry_run"], true);
    EXPECT_EQ(body["polygons"][0], json::parse(R"({
        "id": "p4", "segments": 91, "crossings": 2550, "vertices_added": 2640,
        "triangles_added": 5280, "edges_swapped": 900, "outside": [],
        "max_vertical_deviation": 0.0, "max_plan_deviation": 0.125, "max_elevation_change": 7.5,
        "smallest_angle_deg": {"before": 31.25, "after": 0.5, "p1_before": 35.0,
                               "p1_after": 2.0}})"));
    EXPECT_EQ(body["polygons"][1]["outside"],
              json::parse(R"([{"path": 2, "points": [[1.5, 2.0], [3.0, 4.0]]}])"));
    EXPECT_EQ(body["totals"]["segments"], 92);
    EXPECT_EQ(body["time_ms"],
              json::parse(R"({"locate": 0.25, "integrate": 0.5, "improve": 0.75})"));
    EXPECT_FALSE(body.contains("smallest_angles")) << "they were not asked for";
}

TEST(WriteReport, HasTheCountsOfAngles) {
    const core::Report report;
    core::AngleCounts counts;
    counts.before[9] = 2;
    counts.after = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    const auto body = json::parse(write_report({"s", 4, true, {}, report, std::nullopt, counts}));
    EXPECT_EQ(body["smallest_angles"], json::parse(R"({"step_deg": 5,
        "before": [0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0],
        "after": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]})"));
}

TEST(WriteMeshJson, ReadsBackToTheSameDoubles) {
    core::MeshData mesh;
    mesh.vertices = {{0.1, -1.0 / 3.0, 1e-300},
                     {739012.123456789, 4027310.000000001, -0.0},
                     {std::nextafter(1e9, 2e9), std::numeric_limits<double>::denorm_min(), 1e15}};
    mesh.triangles = {{0, 1, 2}, {4294967294U, 0, 1}};
    const auto body = json::parse(write_mesh_json(mesh));
    ASSERT_EQ(body["vertices"].size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(body["vertices"][i][0].get<double>(), mesh.vertices[i].x);
        EXPECT_EQ(body["vertices"][i][1].get<double>(), mesh.vertices[i].y);
        EXPECT_EQ(body["vertices"][i][2].get<double>(), mesh.vertices[i].z);
    }
    EXPECT_TRUE(std::signbit(body["vertices"][1][2].get<double>()));
    EXPECT_EQ(body["triangles"], json::parse("[[0,1,2],[4294967294,0,1]]"));
}

TEST(WriteMeshJson, WritesAnEmptyMesh) {
    EXPECT_EQ(write_mesh_json({}), "{\"vertices\":[],\"triangles\":[]}\n");
}

TEST(WriteLimits, KeepsWholeNumbersWhole) {
    const std::array<std::pair<std::string_view, double>, 2> limits{{{"a", 268435456}, {"b", 0.5}}};
    EXPECT_EQ(write_limits(limits), "{\"a\":268435456,\"b\":0.5}\n");
}

}  // namespace
}  // namespace tinsmith::api
