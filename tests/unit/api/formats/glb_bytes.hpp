// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace tinsmith::api::testing {

/// Numbers as they lie in a buffer.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
    return out;
}

inline std::string word_bytes(std::size_t value) {
    return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(value)});
}

/// A GLB of a document and its buffer.
inline std::string glb_of(const nlohmann::json& document, std::string bin) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    const std::string chunks = word_bytes(text.size()) + "JSON" + text + word_bytes(bin.size()) +
                               std::string("BIN\0", 4) + bin;
    return "glTF" + word_bytes(2) + word_bytes(12 + chunks.size()) + chunks;
}

/// Two triangles of a square of 4 by 4, y up: floats at byte 0, indices of two bytes at 48.
inline std::string square_bin() {
    return bytes_of(std::vector<float>{0, 1, 0, 4, 2, 0, 4, 3, -4, 0, 4, -4}) +
           bytes_of(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
}

inline nlohmann::json square_document() {
    return nlohmann::json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60}]})");
}

}  // namespace tinsmith::api::testing
