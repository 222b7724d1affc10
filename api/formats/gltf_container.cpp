// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_container.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <nlohmann/json.hpp>

namespace tinsmith::api {
namespace {

using nlohmann::json;

/// A property's view begins at a multiple of 8, as EXT_structural_metadata wants it.
std::size_t add_metadata_view(json& model, GltfBytes& bytes, std::string_view data) {
    const std::size_t offset = bytes.append(data, 8);
    model["bufferViews"].push_back(
        {{"buffer", 0}, {"byteLength", data.size()}, {"byteOffset", offset}});
    return model["bufferViews"].size() - 1;
}

json class_property(const PropertyColumn& column) {
    json property{{"name", column.name}};
    if (!column.description.empty()) property["description"] = column.description;
    if (!column.semantic.empty()) property["semantic"] = column.semantic;
    if (column.is_text) {
        property["type"] = "STRING";
        if (column.no_text) property["noData"] = *column.no_text;
    } else {
        property["type"] = "SCALAR";
        property["componentType"] = "FLOAT64";
        if (column.no_number) property["noData"] = *column.no_number;
    }
    const bool is_in_each_row = !column.no_text && !column.no_number;
    if (is_in_each_row) property["required"] = true;
    return property;
}

void add_metadata(json& model, GltfBytes& bytes, const PropertyTable& table) {
    json properties = json::object(), columns = json::object();
    for (const PropertyColumn& column : table.columns) {
        properties[column.id] = class_property(column);
        json& place = columns[column.id];
        place["values"] = add_metadata_view(model, bytes, column.values);
        if (!column.is_text) continue;
        place["stringOffsets"] =
            add_metadata_view(model, bytes, bytes_of(column.offsets.data(), column.offsets.size()));
        place["stringOffsetType"] = "UINT32";
    }
    const json region{{"name", "Region"}, {"properties", std::move(properties)}};
    const json rows{{"name", "regions"},
                    {"class", "region"},
                    {"count", table.rows},
                    {"properties", std::move(columns)}};
    json& extension = model["extensions"][std::string(kMetadataExtension)];
    extension["schema"] = {{"id", "tinsmith"}, {"classes", {{"region", region}}}};
    extension["propertyTables"] = json::array({rows});
}

void tell_compressed(json& model, const GltfBytes& bytes) {
    for (const GltfBytes::Compressed& view : bytes.compressed()) {
        json extension{{"buffer", 0},
                       {"byteOffset", view.offset},
                       {"byteLength", view.length},
                       {"byteStride", view.stride},
                       {"count", view.count},
                       {"mode", view.is_triangles ? "TRIANGLES" : "ATTRIBUTES"}};
        if (view.is_exponential) extension["filter"] = "EXPONENTIAL";
        model["bufferViews"][view.view]["extensions"][std::string(kMeshoptExtension)] =
            std::move(extension);
    }
}

/// tinygltf writes an empty list as null.
void mend_lists(json& model) {
    for (json& mesh : model["meshes"]) {
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.contains("extras")) continue;
            json& polygons = primitive["extras"]["polygons"];
            if (polygons.is_null()) polygons = json::array();
        }
    }
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(k <= left ? kDigits[group >> (18 - 6 * k) & 63] : '=');
    }
    return text;
}

void append_word(std::string& out, std::size_t word) {
    for (unsigned shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<char>(word >> shift & 0xFF));
}

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

constexpr std::size_t kHeads = 28;  // of a GLB and its two chunks

std::string glb_of(const std::string& text, const GltfBytes& bytes) {
    const std::size_t size = kHeads + padded(text.size()) + padded(bytes.size());
    std::string out;
    out.reserve(size);
    out += "glTF";
    append_word(out, 2);
    append_word(out, size);
    append_word(out, padded(text.size()));
    out += "JSON";
    out += text;
    out.append(padded(text.size()) - text.size(), ' ');
    append_word(out, padded(bytes.size()));
    out += std::string_view("BIN\0", 4);
    bytes.write_to(out);
    out.append(size - out.size(), '\0');
    return out;
}

}  // namespace

std::size_t GltfBytes::append(std::string_view bytes, std::size_t alignment) {
    const std::size_t offset = (size_ + alignment - 1) / alignment * alignment;
    parts_.push_back({offset, bytes});
    size_ = offset + bytes.size();
    return offset;
}

std::size_t GltfBytes::append_own(std::string bytes, std::size_t alignment) {
    return append(own_.emplace_back(std::move(bytes)), alignment);
}

void GltfBytes::write_to(std::string& out) const {
    const std::size_t begin = out.size();
    out.reserve(begin + size_);
    for (const Part& part : parts_) {
        out.append(begin + part.offset - out.size(), '\0');
        out += part.bytes;
    }
}

std::size_t GltfBytes::append_compressed(std::size_t view, const MeshoptView& from) {
    const std::size_t offset = append(from.bytes);
    compressed_.push_back({view, offset, from.bytes.size(), from.count, from.stride,
                           from.is_triangles, from.is_exponential});
    const std::size_t place = (fallback_ + 3) / 4 * 4;
    fallback_ = place + from.count * from.stride;
    return place;
}

std::variant<std::string, EncodeError> pack_gltf(const std::string& model, const GlbScene& scene,
                                                 GltfBytes bytes, GltfContainer container) {
    json document = json::parse(model, nullptr, false);
    if (document.is_discarded())
        return EncodeError{EncodeFault::Codec, "tinygltf wrote what is not JSON"};
    if (scene.table) add_metadata(document, bytes, *scene.table);
    if (!scene.regions.empty())
        document["scenes"][0]["extras"]["regions"] = json::parse(scene.regions, nullptr, false);
    tell_compressed(document, bytes);
    mend_lists(document);
    json buffer{{"byteLength", bytes.size()}};
    if (container == GltfContainer::Json) {
        std::string joined;
        bytes.write_to(joined);
        buffer["uri"] = "data:application/octet-stream;base64," + base64(joined);
    }
    document["buffers"] = json::array({std::move(buffer)});
    if (bytes.fallback_bytes() > 0) {
        document["buffers"].push_back(
            {{"byteLength", bytes.fallback_bytes()},
             {"extensions", {{std::string(kMeshoptExtension), {{"fallback", true}}}}}});
    }
    std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    if (container == GltfContainer::Json) return text;
    // The lengths in a GLB are 32 bits.
    if (kHeads + 8 + text.size() + bytes.size() > std::numeric_limits<std::uint32_t>::max())
        return EncodeError{EncodeFault::TooLarge,
                           "the mesh passes the 4 GiB that a GLB can hold; ask for a smaller bbox "
                           "or for compression=draco"};
    return glb_of(text, bytes);
}

}  // namespace tinsmith::api
