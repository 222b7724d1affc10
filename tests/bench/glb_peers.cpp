// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/glb_peers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <string>

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include "api/formats/draco_encoder.hpp"
#include "api/formats/gltf_pieces.hpp"
#include "api/formats/gltf_scene.hpp"
#include "api/formats/quantization.hpp"

namespace tinsmith::bench {

namespace {

/// As hexadecimal, which is exact.
std::string text_of(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%a", number);
    return text;
}

void add_vectors(draco::Mesh& mesh, draco::GeometryAttribute::Type type,
                 const std::vector<std::array<float, 3>>& vectors) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
    const auto count = static_cast<std::uint32_t>(vectors.size());
    const int id = mesh.AddAttribute(attribute, true, count);
    std::copy(vectors.begin(), vectors.end(),
              reinterpret_cast<std::array<float, 3>*>(mesh.attribute(id)->buffer()->data()));
}

std::vector<std::array<std::uint32_t, 3>> as_exponentials(
    const std::vector<std::array<float, 3>>& vectors, int exponent) {
    std::vector<std::array<std::uint32_t, 3>> made(vectors.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const long steps = std::lrint(std::ldexp(vectors[i][axis], -exponent));
            made[i][axis] = static_cast<std::uint32_t>(exponent) << 24 |
                            (static_cast<std::uint32_t>(steps) & 0xFFFFFF);
        }
    }
    return made;
}

std::size_t encode_vectors(const std::vector<std::array<std::uint32_t, 3>>& vectors) {
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(vectors.size(), 12));
    return meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vectors.data(), vectors.size(),
                                      12);
}

}  // namespace

ReadyBuffers::ReadyBuffers(const core::MeshData& mesh) {
    const api::GltfOptions options;
    const auto coarsest = api::grid_for(api::bounds_of(mesh), options.tolerance);
    if (!coarsest) throw std::runtime_error("the mesh is too wide");
    const auto made = api::best_positions(mesh, 1.0, *coarsest, api::kDracoSteps);
    exponent = made.grid.exponent;
    const auto steps = static_cast<float>(made.grid.step());
    const auto normals_of = api::normal_sums(mesh);
    const auto piece = api::PieceCutter(mesh.vertices.size())
                           .cut<3>(std::span(mesh.triangles), api::all_of(mesh.triangles.size()));
    triangles = piece.corners;
    api::Box<std::int32_t> box;
    for (const std::uint32_t vertex : piece.vertices) {
        const api::GridPoint point = api::to_axes(made.vertices.points[vertex], options.up);
        box.add(point);
        std::array<float, 3>& position = positions.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
            position[axis] = static_cast<float>(point[axis]) * steps;
        normals.push_back(api::smooth_normal(normals_of[vertex], options.up));
    }
    low = box.low;
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent = std::max(extent, box.high[axis] - box.low[axis]);
}

struct DracoAlone::Filled {
    draco::Mesh mesh;
    draco::Encoder encoder;
};

DracoAlone::DracoAlone(const ReadyBuffers& buffers) : filled_(std::make_unique<Filled>()) {
    draco::Mesh& mesh = filled_->mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(buffers.positions.size()));
    add_vectors(mesh, draco::GeometryAttribute::POSITION, buffers.positions);
    add_vectors(mesh, draco::GeometryAttribute::NORMAL, buffers.normals);
    mesh.SetNumFaces(buffers.triangles.size());
    for (std::uint32_t i = 0; i < buffers.triangles.size(); ++i) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k)
            face[k] = draco::PointIndex(buffers.triangles[i][k]);
        mesh.SetFace(draco::FaceIndex(i), face);
    }
    draco::Encoder& encoder = filled_->encoder;
    encoder.SetSpeedOptions(api::kDracoSpeed, api::kDracoSpeed);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    const auto bits = std::bit_width(static_cast<std::uint32_t>(buffers.extent));
    const double step = std::ldexp(1.0, buffers.exponent);
    draco::Options exact;
    exact.SetInt("quantization_bits", static_cast<int>(bits));
    exact.SetString("quantization_origin", text_of(step * buffers.low[0]) + " " +
                                               text_of(step * buffers.low[1]) + " " +
                                               text_of(step * buffers.low[2]));
    exact.SetString("quantization_range",
                    text_of(step * static_cast<double>((std::int64_t{1} << bits) - 1)));
    encoder.options().SetAttributeOptions(draco::GeometryAttribute::POSITION, exact);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, api::kDracoNormalBits);
}

DracoAlone::~DracoAlone() = default;

std::size_t DracoAlone::encode() const {
    draco::EncoderBuffer buffer;
    const draco::Status status = filled_->encoder.EncodeMeshToBuffer(filled_->mesh, &buffer);
    if (!status.ok()) throw std::runtime_error("Draco: " + status.error_msg_string());
    return buffer.size();
}

MeshoptAlone::MeshoptAlone(const ReadyBuffers& buffers)
    : buffers_(buffers),
      positions_(as_exponentials(buffers.positions, buffers.exponent)),
      normals_(as_exponentials(buffers.normals, -12)) {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
}

std::size_t MeshoptAlone::encode() const {
    const std::size_t vertices = positions_.size();
    const std::size_t count = buffers_.triangles.size() * 3;
    std::vector<unsigned int> indices(count), place(vertices);
    meshopt_optimizeVertexCache(indices.data(), buffers_.triangles[0].data(), count, vertices);
    meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), count, vertices);
    meshopt_remapIndexBuffer(indices.data(), indices.data(), count, place.data());
    Exponentials positions(vertices), normals(vertices);
    meshopt_remapVertexBuffer(positions.data(), positions_.data(), vertices, 12, place.data());
    meshopt_remapVertexBuffer(normals.data(), normals_.data(), vertices, 12, place.data());
    std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(count, vertices));
    return encode_vectors(positions) + encode_vectors(normals) +
           meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), count);
}

}  // namespace tinsmith::bench
