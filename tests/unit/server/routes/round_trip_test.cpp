// SPDX-License-Identifier: Apache-2.0
// What goes out comes in again as the same terrain, format by format.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "api/crs.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

using Triangle = std::array<int, 3>;

/// Where a session lies, as its terrain's bytes say it, and as options say it.
struct Where {
    const char* crs;
    const char* unit;
    const char* query;
};
constexpr Where kPlaces[] = {
    {"EPSG:32616", "metre", "?crs=EPSG:32616"},
    {"EPSG:2264", "US survey foot", "?crs=EPSG:2264"},
    {"", "US survey foot", "?unit=US%20survey%20foot"},
    {"", "metre", ""},
};

class RoundTrips : public Handlers {
  protected:
    /// Two patches apart, no coordinate of which is round; in the first one polygon that was raised
    /// and another that is a hole.
    void make(const Where& where) {
        json mesh{{"vertices", json::array()}, {"triangles", json::array()}};
        for (int patch = 0; patch < 2; ++patch) {
            const int first = static_cast<int>(mesh["vertices"].size());
            for (int row = 0; row < kSide; ++row)
                for (int column = 0; column < kSide; ++column)
                    mesh["vertices"].push_back({758'000.1 + 300 * patch + 20.0 * column + row / 3.0,
                                                4'026'000.7 + 20.0 * row + column / 7.0,
                                                std::sin(row) * 9 + column / 11.0 - 3});
            for (int row = 0; row + 1 < kSide; ++row)
                for (int column = 0; column + 1 < kSide; ++column) {
                    const int a = first + row * kSide + column;
                    mesh["triangles"].push_back({a, a + 1, a + kSide + 1});
                    mesh["triangles"].push_back({a, a + kSide + 1, a + kSide});
                }
        }
        json body{{"name", "Two & a hole"}, {"unit", where.unit}, {"mesh", std::move(mesh)}};
        if (*where.crs != '\0') body["crs"] = where.crs;
        put("a", "", "application/json", body.dump());
        for (const char* ring : {"[758020,4026020],[758061.3,4026021],[758061.3,4026061.3],"
                                 "[758020,4026061.3],[758020,4026020]",
                                 "[758083,4026081],[758113,4026082],[758113,4026111],"
                                 "[758083,4026111],[758083,4026081]"})
            good(post("/v1/sessions/a/polygons",
                      R"({"type": "Polygon", "coordinates": [[)" + std::string(ring) + "]]}"));
        good(post("/v1/sessions/a/edits",
                  R"({"operation": "offset", "polygon": "p1", "by": 2.5, "rim": 5})"));
        good(post("/v1/sessions/a/edits", R"({"operation": "remove", "polygon": "p2"})"));
    }

    void put(const std::string& id, const std::string& query, const std::string& type,
             const std::string& body) {
        const Response made =
            ask("PUT", "/v1/sessions/" + id + query, {{"content-type", type}}, body);
        ASSERT_EQ(made.status, 201) << made.body;
    }
    static json good(const Response& response) {
        EXPECT_EQ(response.status, 200) << response.body;
        return json::parse(response.body);
    }
    std::string got(const std::string& target) {
        const Response response = ask("GET", "/v1/sessions/" + target);
        EXPECT_EQ(response.status, 200) << response.body;
        return response.body;
    }
    json session(const std::string& id) { return json::parse(got(id)); }
    void forget(const std::string& id) {
        EXPECT_EQ(ask("DELETE", "/v1/sessions/" + id).status, 200);
    }

    /// Sends what `target` of session a answers as session b.
    void bring_over(const std::string& target, const std::string& query, const std::string& type) {
        const std::string body = got("a/" + target);
        put("b", query, type, body);
        for (const char* same : {"crs", "unit", "vertices", "triangles"})
            EXPECT_EQ(session("b")[same], session("a")[same]) << same;
        EXPECT_EQ(session("b").value("notes", json::array()), json::array());
    }

    static constexpr int kSide = 7;
};

TEST_F(RoundTrips, JsonIsTheSameToTheLastBit) {
    for (const Where& where : kPlaces) {
        SCOPED_TRACE(std::string(where.crs) + where.unit);
        make(where);
        std::string body = R"({"unit": ")" + std::string(where.unit) + R"(", "mesh": )";
        body += got("a/mesh.json");
        if (*where.crs != '\0') body += R"(, "crs": ")" + std::string(where.crs) + '"';
        put("b", "", "application/json", body + "}");
        EXPECT_EQ(got("b/mesh.json"), got("a/mesh.json"));
        put("as-it-is", "", "application/json", got("a/mesh.json"));
        EXPECT_EQ(got("as-it-is/mesh.json"), got("a/mesh.json"));
        forget("as-it-is");
        EXPECT_EQ(session("b")["unit"], where.unit);
        forget("a");
        forget("b");
    }
}

TEST_F(RoundTrips, ObjIsTheSameToTheLastBitWithItsConstraints) {
    for (const Where& where : kPlaces) {
        SCOPED_TRACE(std::string(where.crs) + where.unit);
        make(where);
        const std::string out = "mesh.obj?constraints=true";
        bring_over(out, where.query, "model/obj");
        EXPECT_EQ(got("b/mesh.json"), got("a/mesh.json"));
        EXPECT_NE(got("a/" + out).find("\nl "), std::string::npos) << "no constraint to compare";
        EXPECT_EQ(got("b/" + out), got("a/" + out));
        forget("b");
        bring_over("mesh.obj", where.query, "model/obj");
        EXPECT_EQ(got("b/mesh.json"), got("a/mesh.json"));
        forget("a");
        forget("b");
    }
}

TEST_F(RoundTrips, LandXmlIsTheSameToTheLastBitWithAllThatItSays) {
    for (const Where& where : kPlaces) {
        SCOPED_TRACE(std::string(where.crs) + where.unit);
        make(where);
        bring_over("mesh.xml", "", "application/xml");
        EXPECT_EQ(got("b/mesh.json"), got("a/mesh.json"));
        EXPECT_NE(got("a/mesh.xml").find("<Breakline "), std::string::npos);
        EXPECT_EQ(got("b/mesh.xml"), got("a/mesh.xml"));
        EXPECT_EQ(session("b")["name"], session("a")["name"]);
        forget("a");
        forget("b");
    }
}

/// The number of the vertex within the tolerance of each axis, or -1.
int vertex_near(const json& vertices, const json& position, double tolerance) {
    const auto found = std::find_if(vertices.begin(), vertices.end(), [&](const json& v) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (std::fabs(v[axis].get<double>() - position[axis].get<double>()) > tolerance)
                return false;
        return true;
    });
    return found == vertices.end() ? -1 : static_cast<int>(found - vertices.begin());
}

std::vector<Triangle> triangles_of(const json& mesh, const std::vector<int>& numbers) {
    std::vector<Triangle> out;
    for (const json& t : mesh["triangles"]) {
        Triangle& triangle = out.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            triangle[i] = numbers.at(t[i].get<std::size_t>());
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST_F(RoundTrips, GltfIsTheSameWithinTheToleranceWithSystemUnitAndConstraints) {
    for (const Where& where : kPlaces) {
        make(where);
        const json mesh = json::parse(got("a/mesh.json"));
        std::vector<int> own(mesh["vertices"].size());
        for (std::size_t i = 0; i < own.size(); ++i)
            own[i] = static_cast<int>(i);
        const auto lines = [this](const std::string& id) {
            const std::string text = got(id + "/mesh.obj?constraints=true");
            int count = 0;
            for (std::size_t at = text.find("\nl "); at != text.npos;
                 at = text.find("\nl ", at + 1))
                ++count;
            return count;
        };
        for (const char* compression : {"none", "meshopt", "draco"})
            for (const auto& [path, type] : {std::pair("mesh.glb", "model/gltf-binary"),
                                             std::pair("mesh.gltf", "model/gltf+json")})
                for (const char* up : {"y", "z"}) {
                    SCOPED_TRACE(std::string(where.crs) + where.unit + " " + compression + " " +
                                 path + " " + up);
                    bring_over(std::string(path) + "?tolerance=0.002&compression=" + compression +
                                   "&up=" + up,
                               "", type);
                    const json read = json::parse(got("b/mesh.json"));
                    // Half an ulp of where it lies comes in with the change of the unit.
                    const double tolerance = 0.002 / api::metres_per(where.unit) + 1e-9;
                    std::vector<int> numbers;
                    for (const json& position : read["vertices"])
                        numbers.push_back(vertex_near(mesh["vertices"], position, tolerance));
                    EXPECT_EQ(std::count(numbers.begin(), numbers.end(), -1), 0);
                    EXPECT_EQ(triangles_of(read, numbers), triangles_of(mesh, own));
                    EXPECT_GT(lines("a"), 8);
                    EXPECT_EQ(lines("b"), lines("a"));
                    forget("b");
                }
        forget("a");
    }
}

}  // namespace
}  // namespace tinsmith::server
