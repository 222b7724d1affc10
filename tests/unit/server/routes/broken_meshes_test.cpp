// SPDX-License-Identifier: Apache-2.0
// Every way in which a mesh can be no terrain, spelled in each format that brings a mesh: the same
// fault, and its place in that format's own words.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "core/types/mesh_data.hpp"
#include "tests/unit/api/formats/glb_bytes.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

using core::MeshData;

std::string number(double value) {
    std::ostringstream out;
    out << value;  // "nan" and "inf" as well
    return out.str();
}

std::string as_json(const MeshData& mesh) {
    json vertices = json::array();
    for (const core::Point3& p : mesh.vertices)
        vertices.push_back({p.x, p.y, p.z});
    return json{{"mesh", {{"vertices", vertices}, {"triangles", mesh.triangles}}}}.dump();
}

/// A vertex a line, then a face a line.
std::string as_obj(const MeshData& mesh) {
    std::string out;
    for (const core::Point3& p : mesh.vertices)
        out += "v " + number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
    for (const auto& [a, b, c] : mesh.triangles)
        out += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " +
               std::to_string(c + 1) + "\n";
    return out;
}

/// Points are called P0, P1 and so on; faces have no names and are counted from 1.
std::string as_landxml(const MeshData& mesh) {
    std::string out = "<LandXML><Surfaces><Surface><Definition surfType=\"TIN\"><Pnts>\n";
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const core::Point3& p = mesh.vertices[v];
        out += "<P id=\"P" + std::to_string(v) + "\">" + number(p.y) + " " + number(p.x) + " " +
               number(p.z) + "</P>\n";
    }
    out += "</Pnts><Faces>\n";
    for (const auto& [a, b, c] : mesh.triangles)
        out += "<F>P" + std::to_string(a) + " P" + std::to_string(b) + " P" + std::to_string(c) +
               "</F>\n";
    return out + "</Faces></Definition></Surface></Surfaces></LandXML>";
}

/// Y up, as glTF is.
std::string as_glb(const MeshData& mesh) {
    std::vector<float> positions;
    for (const core::Point3& p : mesh.vertices)
        for (const double value : {p.x, p.z, -p.y})
            positions.push_back(static_cast<float>(value));
    std::vector<std::uint32_t> indices;
    for (const auto& triangle : mesh.triangles)
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    json document = api::testing::square_document();
    const std::size_t split = 4 * positions.size(), end = split + 4 * indices.size();
    document["accessors"][0]["count"] = mesh.vertices.size();
    document["accessors"][1]["count"] = indices.size();
    document["accessors"][1]["componentType"] = 5125;
    document["bufferViews"][0]["byteLength"] = split;
    document["bufferViews"][1] = {
        {"buffer", 0}, {"byteOffset", split}, {"byteLength", end - split}};
    document["buffers"][0]["byteLength"] = end;
    return api::testing::glb_of(
        document, api::testing::bytes_of(positions) + api::testing::bytes_of(indices));
}

struct Spelling {
    const char* type;
    std::string (*write)(const MeshData&);
};
constexpr std::array<Spelling, 4> kSpellings{{{"application/json", as_json},
                                              {"model/obj", as_obj},
                                              {"application/xml", as_landxml},
                                              {"model/gltf-binary", as_glb}}};

/// What is answered to one spelling: the codes of all faults, and words that the first one's
/// detail, pointer or index say its place in. No codes: the mesh is taken, since the format allows
/// for it.
struct Answer {
    std::string codes;
    std::vector<std::string> place;
};

struct Broken {
    const char* name;
    MeshData mesh;
    std::array<Answer, 4> answers;  ///< JSON, OBJ, LandXML, GLB
};

/// The same codes in each, and the place of triangle `t` in each.
std::array<Answer, 4> at_triangle(const MeshData& mesh, std::size_t t, const std::string& codes) {
    const std::string n = std::to_string(t), index = "\"index\":" + n;
    return {{{codes, {"/mesh/triangles/" + n, index}},
             {codes, {"(line " + std::to_string(mesh.vertices.size() + t + 1) + ")", index}},
             {codes, {"(face " + std::to_string(t + 1) + ")", index}},
             {codes, {"(triangle " + n + " of /meshes/0/primitives/0)", index}}}};
}

std::array<Answer, 4> at_vertex(std::size_t v, const std::string& codes) {
    const std::string n = std::to_string(v), index = "\"index\":" + n;
    return {{{codes, {"/mesh/vertices/" + n, index}},
             {codes, {"(line " + std::to_string(v + 1) + ")", index}},
             {codes, {"(point \\\"P" + n + "\\\")", index}},
             {codes, {"vertex " + n, index}}}};
}

const std::vector<core::Point3> kCorners{{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, 3}};

MeshData mesh_of(std::vector<core::Point3> more,
                 std::vector<std::array<std::uint32_t, 3>> triangles) {
    MeshData mesh{kCorners, std::move(triangles), {}};
    mesh.vertices.insert(mesh.vertices.end(), more.begin(), more.end());
    return mesh;
}

std::vector<Broken> broken_meshes() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Broken> all;
    const auto add = [&all](const char* name, MeshData mesh, std::array<Answer, 4> answers) {
        all.push_back({name, std::move(mesh), std::move(answers)});
    };
    MeshData mesh = mesh_of({{5, 0, 9}}, {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}});
    add("a wall: three corners on a line in plan", mesh, at_triangle(mesh, 2, "TRIANGLE_FLAT"));

    mesh = mesh_of({}, {{0, 1, 2}, {0, 2, 3}, {0, 1, 1}});
    add("one corner twice", mesh, at_triangle(mesh, 2, "TRIANGLE_FLAT"));

    mesh = mesh_of({}, {{0, 1, 2}, {0, 3, 2}});
    auto answers = at_triangle(mesh, 1, "TRIANGLE_CLOCKWISE");
    answers[2] = {};  // faces have no order there
    add("seen from below", mesh, answers);

    mesh = mesh_of({{2, 9, 4}}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}});
    add("three at one edge", mesh, at_triangle(mesh, 2, "EDGE_NOT_MANIFOLD"));

    mesh = mesh_of({}, {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}});
    add("one triangle twice", mesh,
        at_triangle(mesh, 2, "EDGE_NOT_MANIFOLD EDGE_NOT_MANIFOLD EDGE_NOT_MANIFOLD"));

    // Twice around vertex 0 before it closes, as a spiral stair does.
    mesh.vertices = {{0, 0, 0},  {10, 0, 1},  {-5, 9, 2},  {-5, -9, 3},
                     {12, 0, 4}, {-6, 11, 5}, {-6, -11, 6}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}};
    add("folded over", mesh, at_vertex(0, "VERTEX_FOLDED"));

    mesh = mesh_of({{2, 1, 9}, {4, 1, 9}, {4, 2, 9}}, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}});
    add("a roof over it", mesh, at_triangle(mesh, 2, "MESH_OVERLAPS"));

    // A cliff: two parts that have an edge in common in plan, one 20 above the other.
    mesh = mesh_of({{10, 0, 21}, {20, 0, 22}, {20, 10, 23}, {10, 10, 22}},
                   {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
    add("an upright step", mesh, at_vertex(4, "ELEVATION_TWICE ELEVATION_TWICE"));

    mesh = mesh_of({{5, 5, 5}}, {{0, 1, 2}, {0, 2, 3}});
    answers = at_vertex(4, "VERTEX_UNUSED");
    answers[2] = answers[3] = {};  // left out, with a note
    add("a vertex of no triangle", mesh, answers);

    mesh = mesh_of({}, {{0, 1, 2}, {0, 2, 7}});
    answers = {{{"VERTEX_INDEX_OUT_OF_RANGE", {"/mesh/triangles/1", "names vertex 7"}},
                {"OBJ_INDEX", {"Line 6", "\\\"8\\\""}},
                {"LANDXML_FACE", {"Face 2", "\\\"P7\\\""}},
                {"GLTF_INVALID", {"/meshes/0/primitives/0/indices"}}}};
    add("an index beyond the vertices", mesh, answers);

    mesh = mesh_of({}, {});
    answers = {{{"MESH_EMPTY", {"no triangle"}},
                {"OBJ_EMPTY", {"no face"}},
                {"MESH_EMPTY", {"no triangle"}},
                {"GLTF_INVALID", {"/scenes", "no triangle"}}}};
    add("no triangle at all", mesh, answers);

    mesh = mesh_of({}, {{0, 1, 2}, {0, 2, 3}});
    mesh.vertices[3].z = kInfinity;
    answers = {{{"WRONG_TYPE", {"/mesh/vertices/3/2"}},  // JSON has no word for it: null
                {"COORDINATE_OUT_OF_RANGE", {"Line 4"}},
                {"COORDINATE_OUT_OF_RANGE", {"\\\"P3\\\""}},
                {"COORDINATE_OUT_OF_RANGE", {"/meshes/0/primitives/0"}}}};
    add("an elevation that is infinite", mesh, answers);

    mesh.vertices[3] = {std::nan(""), 10, 3};
    answers[0].place = {"/mesh/vertices/3/0"};
    add("an easting that is no number", mesh, answers);

    mesh.vertices[3] = {0, 1e12, 3};
    answers[0] = {"COORDINATE_OUT_OF_RANGE", {"/mesh/vertices/3/1"}};
    add("a northing from another planet", mesh, answers);
    return all;
}

class BrokenMeshes : public Handlers {};

TEST_F(BrokenMeshes, AreToldAlikeInEveryFormat) {
    for (const Broken& broken : broken_meshes()) {
        for (std::size_t i = 0; i < kSpellings.size(); ++i) {
            SCOPED_TRACE(std::string(broken.name) + ", " + kSpellings[i].type);
            const auto answer = ask("PUT", "/v1/sessions/s", {{"content-type", kSpellings[i].type}},
                                    kSpellings[i].write(broken.mesh));
            const Answer& wanted = broken.answers[i];
            if (wanted.codes.empty()) {
                EXPECT_EQ(answer.status, 201) << answer.body;
                EXPECT_EQ(ask("DELETE", "/v1/sessions/s").status, 200);
                continue;
            }
            EXPECT_EQ(answer.status, 422) << answer.body;
            EXPECT_EQ(told(answer), wanted.codes) << answer.body;
            const auto body = json::parse(answer.body, nullptr, false);
            const std::string first = body.contains("errors") ? body["errors"][0].dump() : "";
            for (const std::string& words : wanted.place)
                EXPECT_NE(first.find(words), std::string::npos) << words << " in " << first;
        }
    }
}

}  // namespace
}  // namespace tinsmith::server
