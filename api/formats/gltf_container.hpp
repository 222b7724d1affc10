// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/gltf_writer.hpp"

namespace tinsmith::api {

inline constexpr std::string_view kMeshoptExtension = "EXT_meshopt_compression";
inline constexpr std::string_view kMetadataExtension = "EXT_structural_metadata";

/// The bytes of a file's one buffer, none of them copied before the file is put together, and where
/// what is compressed would lie once it is decoded: in a second buffer that holds nothing, the
/// fallback of EXT_meshopt_compression.
class GltfBytes {
  public:
    /// A buffer view with the extension: its index, and where its bytes are.
    struct Compressed {
        std::size_t view = 0;
        std::size_t offset = 0;
        std::size_t length = 0;
        std::size_t count = 0;
        std::size_t stride = 0;
        bool is_triangles = false;
        bool is_exponential = false;
    };

    /// Appends at the next multiple of `alignment` and says where. Requires: the bytes stay where
    /// they are until the file is written.
    std::size_t append(std::string_view bytes, std::size_t alignment = 4);
    /// The same, and keeps them itself.
    std::size_t append_own(std::string bytes, std::size_t alignment = 4);
    /// Appends what is compressed; says where it lies in the fallback.
    std::size_t append_compressed(std::size_t view, const MeshoptView& from);

    std::size_t size() const { return size_; }
    /// Appends all of them, with zeros in between.
    void write_to(std::string& out) const;
    std::size_t fallback_bytes() const { return fallback_; }
    const std::vector<Compressed>& compressed() const { return compressed_; }

  private:
    struct Part {
        std::size_t offset;
        std::string_view bytes;
    };

    std::vector<Part> parts_;
    std::deque<std::string> own_;  ///< its elements never move
    std::size_t size_ = 0;
    std::size_t fallback_ = 0;
    std::vector<Compressed> compressed_;
};

/// Any numbers as the bytes that they are.
template <typename T>
std::string_view bytes_of(const T* data, std::size_t count) {
    return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}

/// Puts into the JSON of a model what tinygltf writes of no model: its buffers, the extension of
/// compressed views, the scene's property table; and makes the file of it.
std::variant<std::string, EncodeError> pack_gltf(const std::string& model, const GlbScene& scene,
                                                 GltfBytes bytes, GltfContainer container);

}  // namespace tinsmith::api
