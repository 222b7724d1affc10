// SPDX-License-Identifier: Apache-2.0
#include "api/formats/meshopt_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <meshoptimizer.h>

namespace tinsmith::api {
namespace {

constexpr int kNormalExponent = -12;
constexpr float kNormalSteps = 4096.0F;  // 2^-kNormalExponent, so that products are exact

/// The extension has the first version of each codec; newer libraries write others unless told.
void choose_codecs() {
    static const bool kOnce = [] {
        meshopt_encodeVertexVersion(0);
        meshopt_encodeIndexVersion(1);
        return true;
    }();
    static_cast<void>(kOnce);
}

/// The nearest whole number, a tie to the even one: a float of this size has no room for a
/// fraction. Requires: |value| < 2^22.
std::int32_t to_whole(float value) {
    constexpr float kWhole = 0x1.8p23F;
    return static_cast<std::int32_t>((value + kWhole) - kWhole);
}

/// n * 2^exponent as the filter takes it: the exponent in the upper 8 bits, n in the lower 24.
std::uint32_t exponential(std::int32_t n, int exponent) {
    return static_cast<std::uint32_t>(exponent) << 24 | (static_cast<std::uint32_t>(n) & 0xFFFFFF);
}

template <typename Element>
MeshoptView encode_elements(const std::vector<Element>& elements) {
    MeshoptView view;
    view.count = elements.size();
    view.stride = sizeof(Element);
    view.bytes.resize(meshopt_encodeVertexBufferBound(elements.size(), sizeof(Element)));
    view.bytes.resize(meshopt_encodeVertexBuffer(
        reinterpret_cast<unsigned char*>(view.bytes.data()), view.bytes.size(), elements.data(),
        elements.size(), sizeof(Element)));
    return view;
}

MeshoptView encode_positions(const MeshoptPiece& piece, std::span<const std::uint32_t> order) {
    bool is_exponential = true;
    for (const GridPoint& point : piece.positions) {
        for (const std::int32_t n : point)
            is_exponential = is_exponential && std::abs(n) <= kMeshoptSteps;
    }
    if (is_exponential) {
        std::vector<std::array<std::uint32_t, 3>> elements(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                elements[i][axis] = exponential(piece.positions[order[i]][axis], piece.exponent);
        }
        MeshoptView view = encode_elements(elements);
        view.is_exponential = true;
        return view;
    }
    // Wider than the filter's mantissa: plain floats, which hold as many steps as there are.
    const float step = std::ldexp(1.0F, piece.exponent);
    std::vector<std::array<float, 3>> elements(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            elements[i][axis] = static_cast<float>(piece.positions[order[i]][axis]) * step;
    }
    return encode_elements(elements);
}

MeshoptView encode_normals(const MeshoptPiece& piece, std::span<const std::uint32_t> order) {
    std::vector<std::array<std::uint32_t, 3>> elements(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float scaled = piece.normals[order[i]][axis] * kNormalSteps;
            elements[i][axis] = exponential(to_whole(scaled), kNormalExponent);
        }
    }
    MeshoptView view = encode_elements(elements);
    view.is_exponential = true;
    return view;
}

MeshoptView encode_indices(const std::vector<unsigned int>& indices, std::size_t vertices) {
    MeshoptView view;
    view.is_triangles = true;
    view.count = indices.size();
    view.stride = sizeof(std::uint32_t);
    view.bytes.resize(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    view.bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(view.bytes.data()),
                                                view.bytes.size(), indices.data(), indices.size()));
    return view;
}

}  // namespace

MeshoptBytes encode_meshopt(const MeshoptPiece& piece) {
    choose_codecs();
    const std::size_t vertices = piece.positions.size();
    std::vector<unsigned int> given;
    given.reserve(piece.triangles.size() * 3);
    for (const auto& corners : piece.triangles)
        given.insert(given.end(), corners.begin(), corners.end());
    std::vector<unsigned int> indices(given.size());
    meshopt_optimizeVertexCache(indices.data(), given.data(), given.size(), vertices);
    std::vector<unsigned int> place(vertices);
    meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), indices.size(), vertices);
    for (unsigned int& index : indices)
        index = place[index];
    std::vector<std::uint32_t> order(vertices);
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex)
        order[place[vertex]] = vertex;

    MeshoptBytes bytes;
    bytes.positions = encode_positions(piece, order);
    if (!piece.normals.empty()) bytes.normals.push_back(encode_normals(piece, order));
    for (const std::uint16_t feature : piece.features)
        bytes.features.push_back(
            encode_elements(std::vector<std::array<std::uint16_t, 2>>(vertices, {feature, 0})));
    bytes.indices = encode_indices(indices, vertices);
    return bytes;
}

}  // namespace tinsmith::api
