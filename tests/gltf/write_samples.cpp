// SPDX-License-Identifier: Apache-2.0
// Writes GLB files of every kind that write_glb makes, each with its mesh as JSON, for the Node
// checks beside this file: gltf_samples DIRECTORY. Prints "NAME TOLERANCE UNIT" for each.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "api/formats/gltf.hpp"

namespace {

using tinsmith::api::Compression;
using tinsmith::api::GltfOptions;
using tinsmith::api::UpAxis;
using tinsmith::core::MeshData;

MeshData hills(std::uint32_t cells, double cell) {
    MeshData mesh;
    for (std::uint32_t row = 0; row <= cells; ++row) {
        for (std::uint32_t column = 0; column <= cells; ++column) {
            const double u = column + 0.3 * std::sin(7.0 * row + column);
            const double v = row + 0.3 * std::sin(5.0 * column + 2.0 * row);
            mesh.vertices.push_back({702113.37 + u * cell, 4029551.81 + v * cell,
                                     411.3 + 80 * std::sin(u / 9) * std::cos(v / 7)});
        }
    }
    for (std::uint32_t row = 0; row < cells; ++row) {
        for (std::uint32_t column = 0; column < cells; ++column) {
            const std::uint32_t a = row * (cells + 1) + column;
            mesh.triangles.push_back({a, a + 1, a + cells + 2});
            mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
            if (row == cells / 2) mesh.constraints.push_back({a, a + 1});
        }
    }
    return mesh;
}

nlohmann::json as_json(const MeshData& mesh) {
    nlohmann::json vertices = nlohmann::json::array();
    for (const auto& v : mesh.vertices)
        vertices.push_back({v.x, v.y, v.z});
    return {{"vertices", std::move(vertices)}, {"triangles", mesh.triangles}};
}

void write(const std::string& directory, const std::string& name, const MeshData& mesh,
           const GltfOptions& options) {
    const auto result = tinsmith::api::write_glb(mesh, options);
    if (const auto* error = std::get_if<tinsmith::api::EncodeError>(&result))
        throw std::runtime_error(name + ": " + error->detail);
    std::ofstream glb(directory + "/" + name + ".glb", std::ios::binary);
    glb << std::get<tinsmith::api::GltfResult>(result).bytes;
    std::ofstream json(directory + "/" + name + ".json");
    json << as_json(mesh);
    if (!glb.flush() || !json.flush()) throw std::runtime_error("cannot write to " + directory);
    std::printf("%s %.17g %.17g\n", name.c_str(), options.tolerance, options.unit_to_metre);
}

void write_all(const std::string& directory) {
    const MeshData park = hills(60, 30);
    write(directory, "draco", park, {});
    write(directory, "draco_z_up", park, {.up = UpAxis::Z});
    write(directory, "draco_feet", park, {.unit_to_metre = 1200.0 / 3937.0});
    write(directory, "draco_coarse", park, {.tolerance = 0.5});
    write(directory, "draco_bare", park, {.constraints = false, .normals = false});
    write(directory, "plain", park, {.compression = Compression::None});
    write(directory, "plain_z_up", park, {.compression = Compression::None, .up = UpAxis::Z});
    // 30 km, one primitive of 22 bits; 12 km cut into tiles; 12 km finer still, with a
    // node for each tile.
    write(directory, "county", hills(150, 200), {});
    write(directory, "tiles", hills(60, 200), {.tolerance = 0x1p-10});
    write(directory, "nodes", hills(40, 300), {.tolerance = 0x1p-12});
    MeshData huge = hills(20, 100);
    const auto first = static_cast<std::uint32_t>(huge.vertices.size());
    huge.vertices.push_back({800000.1, 3980000.2, 3.3});
    huge.vertices.push_back({680000.7, 3980000.4, 7.7});
    huge.triangles.push_back({first + 1, first, 0});
    write(directory, "huge_triangle", huge, {});
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: gltf_samples DIRECTORY\n", stderr);
        return 2;
    }
    try {
        write_all(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gltf_samples: %s\n", error.what());
        return 1;
    }
    return 0;
}
