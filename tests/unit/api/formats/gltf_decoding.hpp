// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <draco/compression/decode.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api::testing {

/// A primitive as a client sees it, in the file's axes.
struct DecodedPrimitive {
    int mode = 4;
    bool compressed = false;
    std::array<double, 3> translation{};
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::uint32_t> indices;
    std::vector<std::vector<std::uint16_t>> features;  ///< _FEATURE_ID_0, _FEATURE_ID_1, ...
    nlohmann::json position_accessor;
    nlohmann::json json;
};

struct DecodedGlb {
    nlohmann::json json;
    std::vector<DecodedPrimitive> primitives;
};

inline std::uint32_t word(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    if (offset + 4 > bytes.size()) throw std::runtime_error("file ends early");
    std::memcpy(&value, bytes.data() + offset, 4);
    return value;
}

template <typename T>
std::vector<T> elements(const nlohmann::json& gltf, std::string_view bin, std::size_t accessor) {
    const auto& description = gltf.at("accessors").at(accessor);
    const auto& view = gltf.at("bufferViews").at(description.at("bufferView").get<std::size_t>());
    std::vector<T> values(description.at("count").get<std::size_t>());
    const auto offset = view.value("byteOffset", std::size_t{0});
    if (offset % 4 != 0 || view.at("byteLength") != values.size() * sizeof(T) ||
        offset + values.size() * sizeof(T) > bin.size())
        throw std::runtime_error("a bufferView that does not fit its accessor");
    std::memcpy(values.data(), bin.data() + offset, values.size() * sizeof(T));
    return values;
}

/// The attributes _FEATURE_ID_n that the object has, from 0 on without a gap.
inline std::vector<std::uint32_t> feature_members(const nlohmann::json& attributes) {
    std::vector<std::uint32_t> members;
    for (std::size_t n = 0; attributes.contains("_FEATURE_ID_" + std::to_string(n)); ++n)
        members.push_back(attributes.at("_FEATURE_ID_" + std::to_string(n)));
    return members;
}

/// The lower half of each: the upper one is padding.
inline std::vector<std::uint16_t> lower_halves(const std::vector<std::uint32_t>& words) {
    std::vector<std::uint16_t> halves;
    for (const std::uint32_t whole : words) {
        if (whole > 0xFFFF) throw std::runtime_error("padding that is not empty");
        halves.push_back(static_cast<std::uint16_t>(whole));
    }
    return halves;
}

/// What EXT_meshopt_compression holds of an accessor's view, decoded by the library.
template <typename T>
std::vector<T> meshopt_elements(const nlohmann::json& gltf, std::string_view bin,
                                std::size_t accessor) {
    const auto& description = gltf.at("accessors").at(accessor);
    const auto& view = gltf.at("bufferViews").at(description.at("bufferView").get<std::size_t>());
    const auto& packed = view.at("extensions").at("EXT_meshopt_compression");
    const auto& fallback = gltf.at("buffers").at(view.at("buffer").get<std::size_t>());
    if (!fallback.at("extensions").at("EXT_meshopt_compression").at("fallback").get<bool>() ||
        view.value("byteOffset", std::size_t{0}) + view.at("byteLength").get<std::size_t>() >
            fallback.at("byteLength").get<std::size_t>())
        throw std::runtime_error("a view beyond its fallback");
    const bool is_triangles = packed.at("mode") == "TRIANGLES";
    const auto count = packed.at("count").get<std::size_t>();
    if (packed.at("byteStride") != sizeof(T) || view.at("byteLength") != count * sizeof(T) ||
        description.at("count") != count)
        throw std::runtime_error("a compressed view that does not fit its accessor");
    const std::string_view bytes = bin.substr(packed.at("byteOffset").get<std::size_t>(),
                                              packed.at("byteLength").get<std::size_t>());
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    std::vector<T> values(count);
    const int failure =
        is_triangles
            ? meshopt_decodeIndexBuffer(values.data(), count, sizeof(T), data, bytes.size())
            : meshopt_decodeVertexBuffer(values.data(), count, sizeof(T), data, bytes.size());
    if (failure != 0) throw std::runtime_error("meshopt cannot decode a view");
    if (packed.contains("filter")) {
        if (packed.at("filter") != "EXPONENTIAL") throw std::runtime_error("another filter");
        meshopt_decodeFilterExp(values.data(), count, sizeof(T));
    }
    return values;
}

inline std::vector<std::array<float, 3>> vectors(const draco::Mesh& mesh, std::uint32_t unique_id) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(unique_id);
    if (attribute == nullptr) throw std::runtime_error("no such Draco attribute");
    std::vector<std::array<float, 3>> values(mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        attribute->GetMappedValue(draco::PointIndex(i), values[i].data());
    return values;
}

inline void decode_draco(const nlohmann::json& extension, std::string_view bytes,
                         DecodedPrimitive& to) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    const auto& attributes = extension.at("attributes");
    to.compressed = true;
    to.positions = vectors(mesh, attributes.at("POSITION").get<std::uint32_t>());
    if (attributes.contains("NORMAL"))
        to.normals = vectors(mesh, attributes.at("NORMAL").get<std::uint32_t>());
    for (const std::uint32_t id : feature_members(attributes)) {
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
        std::vector<std::uint16_t>& values = to.features.emplace_back(mesh.num_points());
        for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
            attribute->GetMappedValue(draco::PointIndex(i), &values[i]);
    }
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner)
            to.indices.push_back(mesh.face(draco::FaceIndex(i))[corner].value());
    }
}

inline DecodedPrimitive decode_primitive(const nlohmann::json& gltf, std::string_view bin,
                                         const nlohmann::json& primitive) {
    DecodedPrimitive to;
    to.mode = primitive.value("mode", 4);
    const auto& attributes = primitive.at("attributes");
    const auto position = attributes.at("POSITION").get<std::size_t>();
    to.position_accessor = gltf.at("accessors").at(position);
    to.json = primitive;
    const auto& view_of_position = gltf.at("accessors").at(position);
    const bool is_meshopt = view_of_position.contains("bufferView") &&
                            gltf.at("bufferViews")
                                .at(view_of_position.at("bufferView").get<std::size_t>())
                                .contains("extensions");
    if (is_meshopt) {
        to.compressed = true;
        to.positions = meshopt_elements<std::array<float, 3>>(gltf, bin, position);
        if (attributes.contains("NORMAL"))
            to.normals = meshopt_elements<std::array<float, 3>>(gltf, bin, attributes.at("NORMAL"));
        to.indices = meshopt_elements<std::uint32_t>(gltf, bin, primitive.at("indices"));
        for (const std::uint32_t accessor : feature_members(attributes))
            to.features.push_back(
                lower_halves(meshopt_elements<std::uint32_t>(gltf, bin, accessor)));
        return to;
    }
    if (primitive.contains("extensions") &&
        primitive.at("extensions").contains("KHR_draco_mesh_compression")) {
        const auto& extension = primitive.at("extensions").at("KHR_draco_mesh_compression");
        const auto& view = gltf.at("bufferViews").at(extension.at("bufferView").get<std::size_t>());
        decode_draco(extension,
                     bin.substr(view.value("byteOffset", std::size_t{0}),
                                view.at("byteLength").get<std::size_t>()),
                     to);
        return to;
    }
    to.positions = elements<std::array<float, 3>>(gltf, bin, position);
    if (attributes.contains("NORMAL"))
        to.normals = elements<std::array<float, 3>>(gltf, bin, attributes.at("NORMAL"));
    to.indices = elements<std::uint32_t>(gltf, bin, primitive.at("indices"));
    for (const std::uint32_t accessor : feature_members(attributes))
        to.features.push_back(lower_halves(elements<std::uint32_t>(gltf, bin, accessor)));
    return to;
}

/// Reads a GLB, strictly as to its header and chunks, and decodes every primitive.
inline DecodedGlb decode_glb(std::string_view file) {
    if (word(file, 0) != 0x46546C67 || word(file, 4) != 2 || word(file, 8) != file.size())
        throw std::runtime_error("not a GLB header");
    const std::size_t json_length = word(file, 12);
    const std::size_t bin_length = word(file, 20 + json_length);
    if (json_length % 4 != 0 || bin_length % 4 != 0 || word(file, 16) != 0x4E4F534A ||
        word(file, 24 + json_length) != 0x004E4942 || 28 + json_length + bin_length != file.size())
        throw std::runtime_error("chunks that are not as they should be");
    const std::string_view bin = file.substr(28 + json_length);
    DecodedGlb glb;
    glb.json = nlohmann::json::parse(file.substr(20, json_length));
    for (const auto& node : glb.json.at("nodes")) {
        const auto& mesh = glb.json.at("meshes").at(node.at("mesh").get<std::size_t>());
        for (const auto& primitive : mesh.at("primitives")) {
            glb.primitives.push_back(decode_primitive(glb.json, bin, primitive));
            glb.primitives.back().translation = node.at("translation");
        }
    }
    return glb;
}

/// The decoded vertex in session axes and metres, as a client computes it in double.
inline core::Point3 placed(const DecodedPrimitive& primitive, std::uint32_t index, bool y_up) {
    const auto& p = primitive.positions.at(index);
    const auto& t = primitive.translation;
    const std::array<double, 3> v{t[0] + double{p[0]}, t[1] + double{p[1]}, t[2] + double{p[2]}};
    return y_up ? core::Point3{v[0], -v[2], v[1]} : core::Point3{v[0], v[1], v[2]};
}

}  // namespace tinsmith::api::testing
