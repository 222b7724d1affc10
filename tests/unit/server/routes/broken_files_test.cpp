// SPDX-License-Identifier: Apache-2.0
// What is wrong with the bytes of a terrain, for each way that each reader tells: the status, the
// code, and where. What is wrong with a mesh whose bytes are fine is in broken_meshes_test.cpp.
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/unit/api/formats/glb_bytes.hpp"
#include "tests/unit/api/formats/tiff_bytes.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

using tinsmith::testing::TiffBytes;

struct BrokenFile {
    std::string body;
    int status;
    std::string codes;  ///< of all faults, in the order told
    std::string place;  ///< in the first of them
};

class BrokenFiles : public Handlers {
  protected:
    void expect_all(const std::string& type, const std::vector<BrokenFile>& files,
                    const std::string& query = "") {
        for (const BrokenFile& file : files) {
            SCOPED_TRACE(type + ": " + file.codes + ", " + file.place);
            const auto answer =
                ask("PUT", "/v1/sessions/s" + query, {{"content-type", type}}, file.body);
            EXPECT_EQ(answer.status, file.status) << answer.body;
            EXPECT_EQ(told(answer), file.codes) << answer.body;
            const auto body = json::parse(answer.body, nullptr, false);
            const std::string first = body.contains("errors") ? body["errors"][0].dump() : "";
            EXPECT_NE(first.find(file.place), std::string::npos) << first;
        }
    }
};

TEST_F(BrokenFiles, OfJson) {
    const std::string grid = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 2, "rows": 2)";
    expect_all(
        "application/json",
        {{R"({"mesh": {"vertices": [[0,0,0])", 400, "JSON_SYNTAX", "byte"},
         {R"({"mesh": {"vertices": [[0,0,NaN]]}})", 400, "JSON_SYNTAX", "byte"},
         {R"({"mesh": {"vertices": [[0,0,1e999]], "triangles": []}})", 422, "NUMBER_OUT_OF_RANGE",
          "/mesh/vertices/0/2"},
         {R"({"mesh": {"vertices": [[0,0]], "triangles": [[0,0,0,0]]}})", 422,
          "WRONG_LENGTH WRONG_LENGTH", "/mesh/vertices/0"},
         {grid + R"(, "elevations": [1,2,3]}})", 422, "WRONG_LENGTH", "/grid/elevations"},
         {grid + R"(, "elevations": [1,2,3,4,5]}})", 422, "WRONG_LENGTH", "/grid/elevations"},
         {grid + R"(, "elevations": [null,null,3,4]}})", 422, "MESH_EMPTY", "/grid"},
         {R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": 4000000000, "rows": 4000000000,
              "elevations": []}})",
          413, "TOO_MANY_VERTICES", "/grid"},
         {R"({"points": [[0,0,0],[1,0,0]]})", 422, "TOO_FEW_POINTS", "/points"},
         {R"({"points": [[0,0,0],[1,0,0],[2,0,0]]})", 422, "POINTS_COLLINEAR", "/points"},
         {R"({"points": [[0,0,0],[1,0,0],[0,1,0],[1,0,3]]})", 422, "ELEVATION_TWICE",
          "/points/3"}});
}

TEST_F(BrokenFiles, OfAnAsciiGrid) {
    const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    expect_all("text/plain",
               {{"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2\n3 4\n", 422, "GRID_HEADER",
                 "no cellsize"},
                {"ncols two\n", 400, "GRID_HEADER", "line 1, column 7"},
                {head + "1 2\n3\n", 400, "GRID_TOO_SHORT", "line 8, column 1"},
                {head + "1 2\n3 4\n5\n", 400, "GRID_TOO_LONG", "line 8, column 1"},
                {head + "1 2\n3 four\n", 400, "GRID_NUMBER", "line 7, column 3"},
                {head + "1 inf\n3 4\n", 422, "COORDINATE_OUT_OF_RANGE", "line 6, column 3"},
                {"ncols 90000000\nnrows 90000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", 413,
                 "TOO_MANY_VERTICES", "90000000"}});
}

TEST_F(BrokenFiles, OfCsv) {
    expect_all("text/csv",
               {{"0,0,0\n1,0\n0,1,0\n", 422, "WRONG_LENGTH", "Line 2, column 3"},
                {"0,0,0\n1,0,nan\n0,1,0\n", 422, "NUMBER_INVALID", "Line 2, column 5"},
                {"0,0,0\n1,0,1e999\n0,1,0\n", 422, "NUMBER_OUT_OF_RANGE", "Line 2, column 5"},
                {"x,y,depth\n0,0,0\n", 422, "COLUMN_MISSING", "Line 1"},
                {"0,0,0\n1,0,0\n", 422, "TOO_FEW_POINTS", "2 distinct"},
                {"0,0,0\n1,1,0\n2,2,0\n", 422, "POINTS_COLLINEAR", "one line"},
                {"0,0,0\n1,0,0\n0,1,0\n1,0,5\n", 422, "ELEVATION_TWICE", "Line 4"}});
}

TEST_F(BrokenFiles, OfObj) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expect_all("model/obj", {{"v 0 0 0\nv 1 0\n", 422, "OBJ_VERTEX", "Line 2"},
                             {corners + "f 1 2", 422, "OBJ_FACE", "Line 4"},
                             {corners + "f 1 2 -9\n", 422, "OBJ_INDEX", "Line 4"},
                             {corners + "f 1 2 3\nfa", 400, "OBJ_KEYWORD", "Line 5"},
                             {corners + "curv 0 1 1 2\n", 422, "OBJ_FREE_FORM", "Line 4"},
                             {"v 0 0 0\nv 9 0 0\nv 9 3 0\nv 6 3 0\nv 6 1 0\nv 3 1 0\nv 3 3 0\nv 0 "
                              "3 0\nf 1 2 3 4 5 6 7 8\n",
                              422, "OBJ_POLYGON", "Line 9"},
                             {"# nothing\n", 422, "OBJ_EMPTY", "no face"}});
}

TEST_F(BrokenFiles, OfLandXml) {
    const auto file = [](const std::string& points, const std::string& faces) {
        return "<LandXML><Surfaces><Surface name=\"S\"><Definition surfType=\"TIN\"><Pnts>\n" +
               points + "</Pnts><Faces>\n" + faces +
               "</Faces></Definition></Surface></Surfaces></LandXML>";
    };
    const std::string points = "<P id=\"a\">0 0 0</P>\n<P id=\"b\">0 1 0</P>\n";
    const std::string whole = file(points + "<P id=\"c\">1 0 0</P>\n", "<F>a b c</F>");
    expect_all(
        "application/xml",
        {{whole.substr(0, whole.size() / 2), 400, "XML_SYNTAX", "Line 3"},
         {"<!DOCTYPE x [<!ENTITY e SYSTEM \"file:///etc/passwd\">]>" + whole, 422, "XML_DOCTYPE",
          "DOCTYPE"},
         {"<gml/>", 422, "LANDXML_MISSING", "gml"},
         {"<LandXML><Surfaces/></LandXML>", 422, "SURFACE_MISSING", "no surface"},
         {file(points + "<P id=\"c\">1 0</P>\n", ""), 422, "LANDXML_POINT", "line 4"},
         {file(points + "<P id=\"b\">1 0 0</P>\n", ""), 422, "LANDXML_ID", "line 4"},
         {file(points, "<F>a b</F>"), 422, "LANDXML_FACE", "Face 1 (line 5)"},
         {file(points, "<F>a b c</F>"), 422, "LANDXML_FACE", "\\\"c\\\", which is not there"},
         {"<LandXML><Units><Metric linearUnit=\"parsec\"/></Units>" + whole.substr(9), 422,
          "UNIT_UNKNOWN", "parsec"}});
}

TEST_F(BrokenFiles, OfGltf) {
    const auto changed = [](const char* pointer, const json& value) {
        json document = api::testing::square_document();
        document[json::json_pointer(pointer)] = value;
        return api::testing::glb_of(document, api::testing::square_bin());
    };
    const auto corpus = [](const std::string& name) {
        std::ifstream in(TINSMITH_SOURCE_DIR "/tests/fuzz/corpus/glb/" + name, std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(in), {}};
    };
    const std::string good = changed("/scene", 0);
    expect_all(
        "model/gltf-binary",
        {{good.substr(0, good.size() - 4), 400, "GLB_SYNTAX", "byte"},
         {"glTF", 400, "GLB_SYNTAX", "byte"},
         {"{\"asset\": {", 400, "GLTF_SYNTAX", ""},
         {changed("/asset/version", "1.0"), 422, "GLTF_VERSION", "/asset/version"},
         {changed("/buffers/0/uri", "https://example.org/t.bin"), 422, "GLTF_URI",
          "/buffers/0/uri"},
         {changed("/buffers/0/uri", "../../etc/passwd"), 422, "GLTF_URI", "/buffers/0/uri"},
         {changed("/extensionsRequired", {"EXT_unheard_of"}), 422, "GLTF_EXTENSION",
          "/extensionsRequired/0"},
         {changed("/accessors/0/sparse", json::object()), 422, "GLTF_SPARSE", "/accessors/0"},
         {changed("/accessors/0/count", 5), 422, "GLTF_INVALID", "/accessors/0"},
         {changed("/accessors/1/count", 5), 422, "GLTF_INVALID", "/meshes/0/primitives/0/indices"},
         {changed("/accessors/0/count", 4'000'000'000U), 413, "TOO_MANY_VERTICES", "/accessors/0"},
         {changed("/bufferViews/1/byteLength", 4000), 422, "GLTF_INVALID", "/bufferViews/1"},
         {changed("/buffers/0/byteLength", 4000), 422, "GLTF_INVALID", "/buffers/0/byteLength"},
         {changed("/nodes/0/children", {0}), 422, "GLTF_INVALID", "/nodes/0"},
         {corpus("draco_damaged.glb"), 422, "GLTF_DRACO", "/meshes/0/primitives/0"},
         {corpus("draco_lies.glb"), 413, "GLTF_DRACO", "/meshes/0/primitives/0"},
         {corpus("meshopt_damaged.glb"), 422, "GLTF_MESHOPT", "/bufferViews/"}});
}

TEST_F(BrokenFiles, OfGeoTiff) {
    const auto tiff = [] {
        return TiffBytes(2, 2, {1, 2, 3, 4}).place(500000, 4000000, 10, 10).projected(32616);
    };
    const std::string good = tiff().bytes();
    expect_all(
        "image/tiff",
        {{good.substr(0, good.size() / 2), 400, "TIFF_SYNTAX", ""},
         {"GIF89a", 400, "TIFF_SYNTAX", "begin"},
         {TiffBytes(2, 2, {1, 2, 3, 4}).bytes(), 422, "TIFF_NOT_GEOREFERENCED", "where"},
         {tiff().set_long(273, 1'000'000).bytes(), 422, "TIFF_DAMAGED", "row 0"},
         {tiff().set_long(273, 0).set_long(279, 0).bytes(), 422, "TIFF_BLOCK_MISSING", "block 0"},
         {tiff().set_long(256, 2'000'000'000).bytes(), 413, "TOO_MANY_VERTICES", "2000000000 by 2"},
         {tiff().geographic(4326).bytes(), 422, "CRS_GEOGRAPHIC", "degrees"},
         {TiffBytes(2, 2, {1, 2, 3e20F, 4}).place(0, 20, 10, 10).bytes(), 422,
          "COORDINATE_OUT_OF_RANGE", "\"coordinate\":[5.0,5.0]"}});
}

}  // namespace
}  // namespace tinsmith::server
