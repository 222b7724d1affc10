// SPDX-License-Identifier: Apache-2.0
// How a terrain's bytes are taken: formats by their type, options, repair.
#include "api/formats/gltf.hpp"
#include "server/terrain_reading.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

constexpr const char* kObj = "# square\nv 0 0 0\nv 10 0 1\nv 10 10 2\nv 0 10 3\nf 1 2 3 4\n";
constexpr const char* kLandXml =
    R"(<?xml version="1.0"?><LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2">
<Units><Metric linearUnit="meter"/></Units><CoordinateSystem epsgCode="32616"/>
<Surfaces><Surface name="Square"><Definition surfType="TIN"><Pnts>
<P id="7">0 0 0</P><P id="8">0 10 1</P><P id="9">10 10 2</P><P id="3">10 0 3</P>
</Pnts><Faces><F>7 8 9</F><F>7 9 3</F></Faces></Definition></Surface></Surfaces></LandXML>)";
/// A triangle twice, once the other way round, one without area, a vertex twice and one unused.
constexpr const char* kBroken = R"({"mesh": {
    "vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3],[0,0,0],[5,5,5]],
    "triangles": [[0,1,2],[0,2,1],[0,0,2],[4,2,3]]}})";

class TerrainRoutes : public Handlers {
  protected:
    Response send(const std::string& query, const std::string& type, const std::string& body) {
        return ask("POST", "/v1/sessions" + query, {{"content-type", type}}, body);
    }
    static json body_of(const Response& response) { return json::parse(response.body); }
};

TEST_F(TerrainRoutes, ReadMeshFilesByTheirType) {
    const auto obj = send("", "model/obj", kObj);
    ASSERT_EQ(obj.status, 201) << obj.body;
    EXPECT_EQ(body_of(obj)["triangles"], 2);
    EXPECT_EQ(body_of(obj)["bounds"], json({0.0, 0.0, 0.0, 10.0, 10.0, 3.0}));
    for (const char* type : {"application/xml", "text/xml", "application/landxml+xml"}) {
        const auto xml = ask("PUT", "/v1/sessions/x", {{"content-type", type}}, kLandXml);
        ASSERT_EQ(xml.status, 201) << xml.body;
        EXPECT_EQ(body_of(xml)["crs"], "EPSG:32616");
        EXPECT_EQ(body_of(xml)["name"], "Square");
        EXPECT_EQ(body_of(xml)["bounds"], json({0.0, 0.0, 0.0, 10.0, 10.0, 3.0}));
        ask("DELETE", "/v1/sessions/x");
    }
    const auto glb =
        ask("GET", "/v1/sessions/" + body_of(obj)["id"].get<std::string>() + "/mesh.glb");
    const auto again = send("", "model/gltf-binary", glb.body);
    ASSERT_EQ(again.status, 201) << again.body;
    EXPECT_EQ(body_of(again)["vertices"], 4);
    EXPECT_EQ(body_of(again)["unit"], "metre");
}

TEST_F(TerrainRoutes, KnowFormatsByTheirFirstBytes) {
    EXPECT_EQ(terrain_format_of(kObj), TerrainFormat::Obj);
    EXPECT_EQ(terrain_format_of("mtllib x.mtl\n"), TerrainFormat::Obj);
    EXPECT_EQ(terrain_format_of(kLandXml), TerrainFormat::LandXml);
    EXPECT_EQ(terrain_format_of("\xEF\xBB\xBF\n<LandXML>"), TerrainFormat::LandXml);
    EXPECT_EQ(terrain_format_of("\xEF\xBB\xBFncols 2\n"), TerrainFormat::AsciiGrid);
    EXPECT_EQ(terrain_format_of("\xEF\xBB\xBF" + std::string(kObj)), TerrainFormat::Obj);
    EXPECT_EQ(terrain_format_of("glTF\2"), TerrainFormat::Glb);
    EXPECT_EQ(terrain_format_of(R"({"asset": {"version": "2.0"}})"), TerrainFormat::Glb);
    EXPECT_EQ(terrain_format_of("\n{ \"bufferViews\": []}"), TerrainFormat::Glb);
    EXPECT_EQ(terrain_format_of(R"({"name": "asset"})"), TerrainFormat::Json);
    EXPECT_EQ(terrain_format_of("{"), TerrainFormat::Json);
    EXPECT_EQ(terrain_format_of(kSquare), TerrainFormat::Json);
    EXPECT_EQ(terrain_format_of(""), TerrainFormat::Json);
    EXPECT_EQ(terrain_format_of("vertices"), TerrainFormat::Json);
    std::string one_line = R"({"mesh": {"vertices": [)";
    for (int i = 0; i < 1000; ++i)
        one_line += "[" + std::to_string(i) + ", 0, 1], ";
    EXPECT_EQ(terrain_format_of(one_line), TerrainFormat::Json);
}

TEST_F(TerrainRoutes, TellRepairsOfPointsByTheirNumbers) {
    const auto made = send("?repair=true&weld=0.1", "application/json",
                           R"({"points": [[0,0,1],[0,0,1],[0,0,1],[10,0,1],[10,10,1],[0,10,1],
                               [5,5,1],[5,5.01,1]]})");
    ASSERT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(body_of(made)["repairs"][0]["code"], "VERTICES_WELDED");
    EXPECT_EQ(body_of(made)["repairs"][0]["indices"], json::parse("[7]"));
}

TEST_F(TerrainRoutes, SayWhenARepairLeavesNothing) {
    const auto refused = send("?repair=true", "model/obj", "v 0 0 0\nv 1 0 0\nv 1 0 5\nf 1 2 3\n");
    EXPECT_EQ(refused.status, 422) << refused.body;
    EXPECT_EQ(told(refused), "NOTHING_LEFT");
}

TEST_F(TerrainRoutes, NameEachFaultWithoutRepair) {
    const auto refused = send("", "application/json", kBroken);
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(told(refused), "TRIANGLE_CLOCKWISE TRIANGLE_FLAT");
    const auto obj = send("", "model/obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 3 2\n");
    EXPECT_EQ(told(obj), "TRIANGLE_CLOCKWISE");
    EXPECT_NE(obj.body.find("(line 5)"), std::string::npos) << obj.body;
}

TEST_F(TerrainRoutes, RepairAndTellEachRepair) {
    const auto made = send("?repair=true", "application/json", kBroken);
    ASSERT_EQ(made.status, 201) << made.body;
    const json repairs = json::parse(R"([
        {"code": "VERTICES_WELDED", "count": 1, "indices": [4]},
        {"code": "TRIANGLES_FLAT", "count": 1, "indices": [2]},
        {"code": "TRIANGLES_TURNED", "count": 1, "indices": [1]},
        {"code": "TRIANGLES_REPEATED", "count": 1, "indices": [1]},
        {"code": "VERTICES_UNUSED", "count": 1, "indices": [5]}])");
    EXPECT_EQ(body_of(made)["repairs"], repairs);
    const std::string session = "/v1/sessions/" + body_of(made)["id"].get<std::string>();
    EXPECT_EQ(body_of(ask("GET", session))["repairs"], repairs);
    EXPECT_EQ(body_of(ask("POST", session + "/fork"))["repairs"], repairs);
    const auto sound = send("?repair=true", "application/json", kSquare);
    EXPECT_EQ(body_of(sound)["repairs"], json::array());
}

TEST_F(TerrainRoutes, RepairLeavesUprightFacesOfAnObjOut) {
    const std::string walled = std::string(kObj) + "v 0 0 -5\nv 10 0 -5\nf 2 1 5 6\n";
    EXPECT_EQ(told(send("", "model/obj", walled)), "TRIANGLE_FLAT TRIANGLE_FLAT");
    const auto made = send("?repair=true", "model/obj", walled);
    ASSERT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(body_of(made)["triangles"], 2);
    EXPECT_EQ(body_of(made)["repairs"][0],
              json::parse(R"({"code": "TRIANGLES_FLAT", "count": 2, "indices": [2, 3]})"));
}

TEST_F(TerrainRoutes, TellWhatRepairCannotMendByTheNumbersGiven) {
    // The last triangle lies over the second; two before it are left out.
    const auto refused = send("?repair=true", "application/json", R"({"mesh": {
        "vertices": [[9,9,9],[0,0,0],[10,0,1],[10,10,2],[0,10,3],[8,5,5]],
        "triangles": [[1,1,2],[1,2,3],[1,2,3],[1,3,4],[1,3,5]]}})");
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(body_of(refused)["errors"][0]["pointer"], "/mesh/triangles/4");
    EXPECT_EQ(body_of(refused)["errors"][0]["code"], "EDGE_NOT_MANIFOLD");
}

TEST_F(TerrainRoutes, RefuseAMeshThatLiesOverItself) {
    const auto refused = send("?repair=true", "model/obj",
                              std::string(kObj) + "v 2 1 9\nv 3 1 9\nv 3 2 9\nf 5 6 7\n");
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(told(refused), "MESH_OVERLAPS");
}

TEST_F(TerrainRoutes, TakeSystemAndUnitWhereTheBytesSayNone) {
    const auto made = send("?crs=epsg:2264&unit=ftUS", "model/obj", kObj);
    ASSERT_EQ(made.status, 201) << made.body;
    EXPECT_EQ(body_of(made)["crs"], "EPSG:2264");
    EXPECT_EQ(body_of(made)["unit"], "US survey foot");
    const auto other = send("?crs=EPSG:32617", "application/xml", kLandXml);
    EXPECT_EQ(told(other), "CONTRADICTION");
    EXPECT_NE(other.body.find("in EPSG:32616, the option crs says EPSG:32617"), std::string::npos);
    EXPECT_EQ(told(send("?unit=foot", "application/xml", kLandXml)), "CONTRADICTION");
    EXPECT_EQ(send("?crs=EPSG:32616&unit=m", "application/xml", kLandXml).status, 201);
    EXPECT_EQ(told(send("?crs=EPSG:4326", "model/obj", kObj)), "CRS_GEOGRAPHIC");
}

TEST_F(TerrainRoutes, RefuseOptionsByName) {
    EXPECT_EQ(told(send("?repair=yes", "model/obj", kObj)), "INVALID_OPTION");
    EXPECT_EQ(told(send("?weld=1", "model/obj", kObj)), "OPTION_INCOMPLETE");
    EXPECT_EQ(told(send("?repair=true&weld=-1", "model/obj", kObj)), "INVALID_OPTION");
    EXPECT_EQ(told(send("?project=auto", "model/obj", kObj)), "PROJECT_WITHOUT_CRS");
    EXPECT_EQ(send("?mend=true", "model/obj", kObj).status, 400);
}

TEST_F(TerrainRoutes, TakeTheSameOptionsInOneRequest) {
    const std::string head = "--b\r\nContent-Disposition: form-data; name=";
    const auto form = [&](const std::string& options) {
        return ask("POST", "/v1/integrate", {{"content-type", "multipart/form-data; boundary=b"}},
                   head + "\"terrain\"\r\n\r\n" + kBroken + "\r\n" + head + "\"polygons\"\r\n\r\n" +
                       kParcel + "\r\n" + head + "\"options\"\r\n\r\n" + options + "\r\n--b--\r\n");
    };
    const auto done = form(R"({"repair": true, "terrain_crs": "EPSG:32616", "crs": "EPSG:32616"})");
    ASSERT_EQ(done.status, 200) << done.body;
    EXPECT_EQ(body_of(done)["repairs"].size(), 5U);
    EXPECT_EQ(told(form(R"({"repair": true, "terrain_crs": "EPSG:32616", "crs": "EPSG:32617"})")),
              "OUTSIDE_MESH");  // brought over from the neighbouring zone
    EXPECT_EQ(told(form(R"({"weld": 2})")).substr(0, 17), "OPTION_INCOMPLETE");
}

}  // namespace
}  // namespace tinsmith::server
