// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/draco_encoder.hpp"

namespace tinsmith::api {

enum class GlbMode { Triangles, Lines };

/// One primitive in glTF's axes. Either `draco` holds everything and the three arrays are empty,
/// or the arrays hold it plainly: positions and normals as x, y, z in turn.
struct GlbPrimitive {
    GlbMode mode = GlbMode::Triangles;
    std::array<double, 3> low{};  ///< box of the float32 positions as clients decode them
    std::array<double, 3> high{};
    std::optional<DracoBytes> draco;
    std::vector<float> positions;
    std::vector<float> normals;  ///< empty: none
    std::vector<std::uint32_t> indices;
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
};

/// The scene as a binary glTF 2.0 file: a JSON chunk and one BIN chunk, all aligned to 4 bytes.
/// KHR_draco_mesh_compression is named as used and required exactly when a primitive needs it.
/// The same scene gives the same bytes. Fails only beyond the 4 GiB of a GLB.
/// Cost: the buffers are copied three times.
std::variant<std::string, EncodeError> write_glb_file(const GlbScene& from);

}  // namespace tinsmith::api
