// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "server/regions.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class RegionRoutes : public Handlers {
  protected:
    std::string session = make_session();

    void cut(const std::string& coordinates, const std::string& type = "Polygon") {
        const Response made =
            post(session + "/polygons",
                 R"({"type": ")" + type + R"(", "coordinates": )" + coordinates + "}");
        ASSERT_EQ(made.status, 200) << made.body;
    }
    json region(const std::string& id) {
        const Response answer = ask("GET", session + "/regions/" + id);
        EXPECT_EQ(answer.status, 200) << answer.body;
        return json::parse(answer.body);
    }
    json mesh() { return json::parse(ask("GET", session + "/mesh.json").body); }

    /// The plan area of triangles of the JSON mesh.
    static double area_of(const json& mesh, const json& triangles) {
        double sum = 0.0;
        for (const json& t : triangles) {
            const json& corners = mesh["triangles"][t.get<std::size_t>()];
            double x[3], y[3];
            for (std::size_t i = 0; i < 3; ++i) {
                x[i] = mesh["vertices"][corners[i].get<std::size_t>()][0];
                y[i] = mesh["vertices"][corners[i].get<std::size_t>()][1];
            }
            sum += ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
        }
        return sum;
    }
};

TEST_F(RegionRoutes, SelectTrianglesOfTheJsonMesh) {
    cut("[[[2,1],[6,1],[6,5],[2,5],[2,1]]]");
    const json region = this->region("p1");
    EXPECT_EQ(region["polygon"], "p1");
    EXPECT_EQ(region["version"], 2);
    EXPECT_EQ(region["unit"], "metre");
    EXPECT_EQ(region["winding"], "evenodd");
    EXPECT_NEAR(region["plan_area"].get<double>(), 16.0, 1e-12);
    EXPECT_NEAR(area_of(mesh(), region["triangles"]), 16.0, 1e-12);
    EXPECT_TRUE(std::is_sorted(region["triangles"].begin(), region["triangles"].end()));
    EXPECT_EQ(region["within"], json::array());
    EXPECT_EQ(region["shared"], json::array());
    const json draped = json::parse(ask("GET", session + "/polygons/p1").body)["tinsmith"];
    EXPECT_EQ(region["triangles"].size(), draped["triangles"]);
    EXPECT_EQ(region["surface_area"], draped["surface_area"]);
}

TEST_F(RegionRoutes, TellTheBorderWithTheRegionOnItsLeft) {
    cut("[[[2,1],[2,5],[6,5],[6,1],[2,1]]]");  // drawn clockwise
    const json edges = region("p1")["edges"];
    ASSERT_EQ(edges.size(), 1U);
    EXPECT_EQ(edges[0]["polygons"], json::parse(R"(["p1"])"));
    const json mesh = this->mesh();
    double area = 0.0;
    for (const json& edge : edges[0]["vertices"]) {
        const json& a = mesh["vertices"][edge[0].get<std::size_t>()];
        const json& b = mesh["vertices"][edge[1].get<std::size_t>()];
        area +=
            (a[0].get<double>() * b[1].get<double>() - b[0].get<double>() * a[1].get<double>()) / 2;
    }
    EXPECT_NEAR(area, 16.0, 1e-12);
}

TEST_F(RegionRoutes, AreFeaturesForGisPrograms) {
    const Response made = post(session + "/polygons", R"({"type": "Feature", "properties":
        {"name": "Pad", "plan_area": "mine", "use": "parking"}, "geometry": {"type": "Polygon",
        "coordinates": [[[1,1],[6,1],[6,6],[1,6],[1,1]],[[2,2],[2,3],[3,3],[3,2],[2,2]]]}})");
    ASSERT_EQ(made.status, 200) << made.body;
    cut("[[4,2],[20,2]]", "LineString");
    cut("[[[8,8],[12,8],[12,12],[8,12],[8,8]]]");  // half of it off the mesh
    const Response all = ask("GET", session + "/regions", {{"accept", "application/geo+json"}});
    ASSERT_EQ(all.status, 200);
    EXPECT_EQ(all.content_type, "application/geo+json");
    EXPECT_NE(header(all, "ETag"), header(ask("GET", session + "/regions"), "ETag"));
    const json list = json::parse(all.body);
    EXPECT_EQ(list["crs"]["properties"]["name"], "EPSG:32616");
    ASSERT_EQ(list["features"].size(), 2U);
    const json& first = list["features"][0];
    EXPECT_EQ(first["properties"]["id"], "p1");
    EXPECT_EQ(first["properties"]["name"], "Pad");
    EXPECT_EQ(first["properties"]["use"], "parking");
    EXPECT_EQ(first["properties"]["plan_area_2"], "mine");
    EXPECT_EQ(first["properties"]["plan_area"], region("p1")["plan_area"]);
    EXPECT_EQ(first["properties"]["triangles"], region("p1")["triangles"].size());
    const json& polygons = first["geometry"]["coordinates"];
    ASSERT_EQ(polygons.size(), 1U);
    ASSERT_EQ(polygons[0].size(), 2U) << "with its hole";
    EXPECT_EQ(polygons[0][0].front(), polygons[0][0].back());
    EXPECT_EQ(polygons[0][0][0].size(), 3U);
    const json& half = list["features"][1];
    EXPECT_EQ(half["geometry"]["type"], "MultiPolygon") << "what of it lies on the mesh";
    EXPECT_NEAR(half["properties"]["plan_area"].get<double>(), 4.0, 1e-12);
    const json one =
        json::parse(ask("GET", session + "/regions/p3", {{"accept", "application/geo+json"}}).body);
    EXPECT_EQ(one["geometry"], half["geometry"]);
}

class ConstraintRoutes : public RegionRoutes {};

TEST_F(ConstraintRoutes, ChainTheEdgesByTheirPolygons) {
    EXPECT_EQ(json::parse(ask("GET", session + "/constraints").body)["features"], json::array());
    cut("[[[1,1],[6,1],[6,6],[1,6],[1,1]]]");
    cut("[[[6,2],[9,2],[9,5],[6,5],[6,2]]]");  // shares [2,5] of the side x = 6
    const Response all = ask("GET", session + "/constraints");
    EXPECT_EQ(all.content_type, "application/geo+json");
    const json list = json::parse(all.body);
    std::map<json, double> lengths;
    for (const json& feature : list["features"]) {
        EXPECT_EQ(feature["properties"]["locked"], false);
        lengths[feature["properties"]["polygons"]] += feature["properties"]["length"].get<double>();
    }
    ASSERT_EQ(lengths.size(), 3U);
    EXPECT_NEAR(lengths[json::array({"p1"})], 17.0, 1e-12);
    EXPECT_NEAR(lengths[json::array({"p2"})], 9.0, 1e-12);
    EXPECT_NEAR(lengths[json::array({"p1", "p2"})], 3.0, 1e-12);
    json pages = json::array();
    std::string next = session + "/constraints?limit=1";
    while (!next.empty()) {
        const Response page = ask("GET", next);
        ASSERT_EQ(page.status, 200);
        pages.push_back(json::parse(page.body)["features"][0]);
        const std::string link = header(page, "Link");
        next = link.empty() ? "" : link.substr(1, link.find('>') - 1);
    }
    EXPECT_EQ(pages, list["features"]);

    // Lines are in the order of one version: pages of two would lose some and repeat others.
    const Response before = ask("GET", session + "/constraints?limit=1");
    cut("[[[8,8],[9,8],[9,9],[8,9],[8,8]]]");
    const std::string link = header(before, "Link");
    const Response after = ask("GET", link.substr(1, link.find('>') - 1));
    EXPECT_EQ(after.status, 400);
    EXPECT_NE(after.body.find("CURSOR_OUTDATED"), std::string::npos) << after.body;
}

TEST_F(RegionRoutes, TellWhatOthersContain) {
    cut("[[[1,1],[6,1],[6,6],[1,6],[1,1]]]");
    cut("[[[4,2],[9,2],[9,5],[4,5],[4,2]]]");  // p2 shares [4,6] x [2,5] with p1
    cut("[[[2,2],[3,2],[3,3],[2,3],[2,2]]]");  // p3 lies in p1
    cut("[[[8,8],[9,8],[9,9],[8,9],[8,8]]]");  // p4 is on its own
    const json first = region("p1");
    const json mesh = this->mesh();
    EXPECT_EQ(first["within"], json::array());
    ASSERT_EQ(first["shared"].size(), 2U);
    EXPECT_EQ(first["shared"][0]["polygons"], json::parse(R"(["p2"])"));
    EXPECT_NEAR(area_of(mesh, first["shared"][0]["triangles"]), 6.0, 1e-12);
    EXPECT_EQ(first["shared"][1]["polygons"], json::parse(R"(["p3"])"));
    EXPECT_NEAR(area_of(mesh, first["shared"][1]["triangles"]), 1.0, 1e-12);
    const json third = region("p3");
    EXPECT_EQ(third["within"], json::parse(R"(["p1"])"));
    EXPECT_EQ(third["shared"][0]["triangles"], third["triangles"]);
    EXPECT_EQ(region("p4")["shared"], json::array());
    // p1's own border, and of p2 and p3 what lies in it, each edge once.
    std::set<std::string> seen;
    for (const json& along : first["edges"]) {
        for (const json& edge : along["vertices"]) {
            std::array<int, 2> ends{edge[0], edge[1]};
            std::ranges::sort(ends);
            EXPECT_TRUE(seen.insert(json(ends).dump()).second);
        }
    }
    EXPECT_EQ(first["edges"].size(), 3U);
}

TEST_F(RegionRoutes, TellWhoRunsAlongASharedBorder) {
    cut("[[[1,1],[4,1],[4,4],[1,4],[1,1]]]");
    cut("[[[4,1],[7,1],[7,4],[4,4],[4,1]]]");
    cut("[[4,1],[4,4]]", "LineString");
    const json edges = region("p2")["edges"];
    ASSERT_EQ(edges.size(), 2U);
    EXPECT_EQ(edges[0]["polygons"], json::parse(R"(["p1","p2","p3"])"));
    EXPECT_EQ(edges[1]["polygons"], json::parse(R"(["p2"])"));
    EXPECT_EQ(region("p1")["shared"], json::array()) << "a border is not an inside";
}

TEST_F(RegionRoutes, ComeInPagesWithoutLines) {
    cut("[[[1,1],[3,1],[3,3],[1,3],[1,1]]]");
    cut("[[0,5],[9,5]]", "LineString");
    cut("[[[2,2],[5,2],[5,4],[2,4],[2,2]]]");
    cut("[[[6,6],[8,6],[8,8],[6,8],[6,6]]]");
    const Response all = ask("GET", session + "/regions");
    ASSERT_EQ(all.status, 200) << all.body;
    const json list = json::parse(all.body)["regions"];
    ASSERT_EQ(list.size(), 3U);
    json pages = json::array();
    std::string next = session + "/regions?limit=1";
    while (!next.empty()) {
        const Response page = ask("GET", next);
        pages.push_back(json::parse(page.body)["regions"][0]);
        const std::string link = header(page, "Link");
        next = link.empty() ? "" : link.substr(1, link.find('>') - 1);
    }
    EXPECT_EQ(pages, list);
    json alone = region("p3");
    for (const char* name : {"session", "version", "unit"})
        alone.erase(name);
    EXPECT_EQ(alone, list[1]);
    EXPECT_EQ(ask("GET", session + "/regions", {{"if-none-match", header(all, "ETag")}}).status,
              304);
}

TEST_F(RegionRoutes, RefuseWhatHasNone) {
    cut("[[0,5],[9,5]]", "LineString");
    EXPECT_EQ(told(ask("GET", session + "/regions/p1")), "no-such-polygon");
    EXPECT_EQ(told(ask("GET", session + "/regions/p2")), "no-such-polygon");
    EXPECT_EQ(told(ask("GET", session + "/regions?cursor=x")), "INVALID_PARAMETER");
}

TEST_F(RegionRoutes, TellNestedOnesInOrder) {
    for (const char* ring :
         {"[[[1,1],[9,1],[9,9],[1,9],[1,1]]]", "[[[2,2],[8,2],[8,8],[2,8],[2,2]]]",
          "[[[3,3],[7,3],[7,7],[3,7],[3,3]]]"})
        cut(ring);
    const json shared = region("p2")["shared"];
    ASSERT_EQ(shared.size(), 2U);
    EXPECT_EQ(shared[0]["polygons"], json::parse(R"(["p1"])"));
    EXPECT_EQ(shared[1]["polygons"], json::parse(R"(["p1","p3"])"));
    EXPECT_NEAR(area_of(mesh(), shared[1]["triangles"]), 16.0, 1e-12);
    EXPECT_EQ(region("p2")["within"], json::parse(R"(["p1"])"));
    EXPECT_EQ(region("p3")["within"], json::parse(R"(["p1","p2"])"));
}

class CostlyRegions : public RegionRoutes {
  protected:
    void SetUp() override {
        cut("[[[1,1],[9,1],[9,9],[1,9],[1,1]]]");
        cut("[[[2,2],[8,2],[8,8],[2,8],[2,2]]]");
    }
    /// What finding both regions comes to under these limits.
    core::Result<std::vector<api::RegionView>> find(const RegionLimits& limits) {
        const auto found = services.sessions.find(session.substr(13), {});
        const RegionGround ground = found->look(
            [](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t) {
                const std::vector<std::size_t> both{0, 1};
                return region_ground(tin, polygons, both);
            });
        return find_regions(ground, limits);
    }
};

TEST_F(CostlyRegions, AreRefused) {
    EXPECT_TRUE(find({}).ok());
    EXPECT_TRUE(find({1000, {}}).ok());
    const auto refused = find({30, {}});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.errors()[0].code, core::ErrorCode::CrossingBudget);
}

TEST_F(CostlyRegions, StopBetweenPolygons) {
    int asked = 0;
    const auto stopped = find({UINT64_MAX, [&asked] { return ++asked == 2; }});
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.errors()[0].code, core::ErrorCode::Cancelled);
}

TEST_F(CostlyRegions, EndWithTheService) {
    services.stopping = true;
    for (const char* path : {"/regions", "/regions/p1"}) {
        const Response answer = ask("GET", session + path);
        EXPECT_EQ(answer.status, 503) << answer.body;
        EXPECT_EQ(told(answer), "CANCELLED");
    }
}

}  // namespace
}  // namespace tinsmith::server
