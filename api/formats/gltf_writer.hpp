// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/draco_encoder.hpp"
#include "api/formats/gltf_features.hpp"
#include "api/formats/meshopt_encoder.hpp"
#include "api/unwritten.hpp"

namespace tinsmith::api {

enum class GlbMode { Triangles, Lines };

/// One primitive in glTF's axes. Either `draco` or `meshopt` holds everything and the three arrays
/// are empty, or the arrays hold it plainly.
struct GlbPrimitive {
    GlbMode mode = GlbMode::Triangles;
    std::array<double, 3> low{};  ///< box of the float32 positions as clients decode them
    std::array<double, 3> high{};
    std::optional<DracoBytes> draco;
    std::optional<MeshoptBytes> meshopt;
    Unwritten<std::array<float, 3>> positions;
    Unwritten<std::array<float, 3>> normals;  ///< empty: none
    std::vector<std::uint32_t> indices;
    /// In place of the indices: someone else's, there for as long as the scene is.
    std::span<const std::uint32_t> shared_indices;
    /// The rows of the property table that all its vertices have, the row beyond the last for none;
    /// none at all: it is not of a region.
    std::vector<std::uint16_t> features;
    std::vector<std::string> polygons;  ///< ids, told in `extras` beside the features

    std::span<const std::uint32_t> plain_indices() const {
        return shared_indices.empty() ? std::span(indices) : shared_indices;
    }
};

/// A node with one mesh; the translation is written as JSON doubles.
struct GlbNode {
    std::string name;
    std::array<double, 3> translation{};
    std::vector<GlbPrimitive> primitives;
};

/// What is said about the file beside its geometry: members of the scene's `extras`.
using GlbExtra = std::variant<double, std::size_t, std::string, std::array<double, 3>>;

struct GlbScene {
    std::string generator;
    std::vector<GlbNode> nodes;
    std::vector<std::pair<std::string, GlbExtra>> extras;
    std::optional<PropertyTable> table;  ///< what the primitives' features are rows of
    std::string regions;                 ///< JSON text for the `extras`; empty: none
};

enum class GltfContainer {
    Glb,   ///< binary glTF 2.0: a JSON chunk and one BIN chunk, all aligned to 4 bytes
    Json,  ///< glTF 2.0 as JSON, the buffer in it as a data URI
};

/// The scene as a file. Extensions are named as used and required exactly when something needs
/// them. The same scene gives the same bytes. Fails only beyond the 4 GiB of a GLB.
/// Cost: the buffers are copied once.
std::variant<std::string, EncodeError> write_gltf_file(const GlbScene& from,
                                                       GltfContainer container);

}  // namespace tinsmith::api
