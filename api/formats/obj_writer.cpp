// SPDX-License-Identifier: Apache-2.0
#include "api/formats/obj_writer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "api/formats/json_writer.hpp"

namespace tinsmith::api {
namespace {

template <std::size_t N>
void append_element(std::string& out, char kind, const std::array<std::uint32_t, N>& corners) {
    out.push_back(kind);
    for (const std::uint32_t corner : corners) {
        out.push_back(' ');
        json::append_number(out, std::uint64_t{corner} + 1);
    }
    out.push_back('\n');
}

}  // namespace

std::string write_obj(const core::MeshData& mesh, bool constraints, const std::string& comment) {
    constexpr std::size_t kOfALine = 48;
    std::string out;
    out.reserve((mesh.vertices.size() + mesh.triangles.size()) * kOfALine);
    // A line that ends in a backslash goes on.
    std::string line = comment;
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\\') c = ' ';
    }
    out.append("# ").append(line).append("\no terrain\n");
    for (const core::Point3& vertex : mesh.vertices) {
        out.push_back('v');
        for (const double coordinate : {vertex.x, vertex.y, vertex.z}) {
            out.push_back(' ');
            json::append_coordinate(out, coordinate);
        }
        out.push_back('\n');
    }
    for (const auto& corners : mesh.triangles)
        append_element(out, 'f', corners);
    if (!constraints || mesh.constraints.empty()) return out;
    // An object of their own: readers such as three's take one with lines for lines altogether.
    out += "o constraints\n";
    for (const auto& ends : mesh.constraints)
        append_element(out, 'l', ends);
    return out;
}

}  // namespace tinsmith::api
