// SPDX-License-Identifier: Apache-2.0
// OBJ and LandXML, read back by simple parsers: the very same mesh.
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "api/formats/landxml_writer.hpp"
#include "api/formats/obj_writer.hpp"
#include "tests/unit/api/formats/gltf_matching.hpp"

namespace tinsmith::api {
namespace {

/// Doubles with many digits, very small ones, both noughts.
core::MeshData hard_numbers() {
    core::MeshData mesh = testing::hills(6, 5, 30);
    mesh.vertices[0].x += 0.1;
    mesh.vertices[1].z = -0.0;
    mesh.vertices[2].z = std::numeric_limits<double>::min();
    mesh.vertices[3].z = 1.0 / 3.0;
    mesh.vertices[4].z = -123456789.0123456789;
    return mesh;
}

bool same_bits(const core::Point3& a, const core::Point3& b) {
    const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

void expect_same(const core::MeshData& read, const core::MeshData& mesh) {
    ASSERT_EQ(read.vertices.size(), mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        EXPECT_TRUE(same_bits(read.vertices[i], mesh.vertices[i])) << i;
    EXPECT_EQ(read.triangles, mesh.triangles);
}

core::MeshData read_obj(const std::string& text) {
    core::MeshData mesh;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            std::array<std::string, 3> word;
            words >> word[0] >> word[1] >> word[2];
            mesh.vertices.push_back({std::strtod(word[0].c_str(), nullptr),
                                     std::strtod(word[1].c_str(), nullptr),
                                     std::strtod(word[2].c_str(), nullptr)});
        } else if (kind == "f") {
            std::array<std::uint32_t, 3> t{};
            words >> t[0] >> t[1] >> t[2];
            mesh.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
        } else if (kind == "l") {
            std::array<std::uint32_t, 2> e{};
            words >> e[0] >> e[1];
            mesh.constraints.push_back({e[0] - 1, e[1] - 1});
        } else {
            EXPECT_TRUE(kind == "#" || kind == "o") << line;
        }
    }
    return mesh;
}

std::vector<double> numbers_in(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;)
        numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
}

core::MeshData read_landxml(const std::string& text) {
    core::MeshData mesh;
    const std::regex point(R"re(<P id="(\d+)">([^<]*)</P>)re"), face(R"re(<F>([^<]*)</F>)re");
    for (std::sregex_iterator at(text.begin(), text.end(), point), end; at != end; ++at) {
        EXPECT_EQ(std::stoul((*at)[1]), mesh.vertices.size() + 1);
        const auto numbers = numbers_in((*at)[2]);
        mesh.vertices.push_back({numbers.at(1), numbers.at(0), numbers.at(2)});
    }
    for (std::sregex_iterator at(text.begin(), text.end(), face), end; at != end; ++at) {
        const auto numbers = numbers_in((*at)[1]);
        std::array<std::uint32_t, 3>& t = mesh.triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            t[i] = static_cast<std::uint32_t>(numbers.at(i)) - 1;
    }
    return mesh;
}

TEST(WriteObj, ReadsBackAsTheSameMesh) {
    const core::MeshData mesh = hard_numbers();
    const core::MeshData read = read_obj(write_obj(mesh, false, "hills"));
    expect_same(read, mesh);
    EXPECT_TRUE(read.constraints.empty());
    EXPECT_EQ(read_obj(write_obj(mesh, true, "hills")).constraints, mesh.constraints);
}

TEST(WriteObj, ACommentStaysOnItsLine) {
    const std::string text = write_obj(testing::hills(1, 1, 1), false, "a\nv 1 2 3\\");
    EXPECT_TRUE(text.starts_with("# a v 1 2 3 \no terrain\nv ")) << text;
}

TEST(WriteLandXml, ReadsBackAsTheSameMesh) {
    const core::MeshData mesh = hard_numbers();
    const std::string text = write_landxml(mesh, {"Hills", "EPSG:32616", "metre", true});
    expect_same(read_landxml(text), mesh);
    EXPECT_EQ(text, write_landxml(mesh, {"Hills", "EPSG:32616", "metre", true}));
}

TEST(WriteLandXml, HasItsElementsInTheOrderOfTheSchema) {
    const std::string text =
        write_landxml(testing::hills(3, 3, 10), {"A <b> & \"c\"\n", "EPSG:2264", "US survey foot"});
    std::size_t at = 0;
    for (const char* next : {"<?xml version=\"1.0\"",
                             "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\"",
                             "<Units><Imperial",
                             "linearUnit=\"USSurveyFoot\"",
                             "<CoordinateSystem name=\"EPSG:2264\"",
                             "epsgCode=\"2264\"",
                             "<Project name=\"A &lt;b&gt; &amp; &quot;c&quot; \"/>",
                             "<Application name=",
                             "<Surfaces>",
                             "<Surface name=",
                             "<SourceData>",
                             "<Breaklines>",
                             "<Breakline brkType=\"standard\"><PntList3D>",
                             "</SourceData>",
                             "<Definition surfType=\"TIN\">",
                             "<Pnts>",
                             "</Pnts>",
                             "<Faces>",
                             "</Faces>",
                             "</Surfaces>"}) {
        const std::size_t found = text.find(next, at);
        ASSERT_NE(found, std::string::npos) << next;
        at = found;
    }
    EXPECT_NE(write_landxml({}, {"a\xEF\xBF\xBFz", "", "foot"}).find("name=\"a?z\""),
              std::string::npos);
    EXPECT_NE(write_landxml({}, {"", "", "foot"}).find("linearUnit=\"foot\""), std::string::npos);
    EXPECT_EQ(write_landxml({}, {"", "", "metre"}).find("CoordinateSystem"), std::string::npos);
}

TEST(WriteLandXml, BreaklinesAreTheConstrainedEdgesEndToEnd) {
    core::MeshData mesh = testing::hills(4, 3, 10);
    const std::string text = write_landxml(mesh, {"", "", "metre", true});
    const std::regex line(R"re(<PntList3D>([^<]*)</PntList3D>)re");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, line));
    const auto numbers = numbers_in(found[1]);
    ASSERT_EQ(numbers.size(), 3 * (mesh.constraints.size() + 1));
    EXPECT_EQ(numbers[0], mesh.vertices[mesh.constraints[0][0]].y) << "northing first";
    EXPECT_EQ(write_landxml(mesh, {"", "", "metre", false}).find("SourceData"), std::string::npos);
}

}  // namespace
}  // namespace tinsmith::api
