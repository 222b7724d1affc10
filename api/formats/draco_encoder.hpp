// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/gltf_error.hpp"
#include "api/formats/quantization.hpp"

namespace tinsmith::api {

/// One triangle mesh for Draco, in glTF's axes: positions in steps of 2^exponent metres from the
/// node, unit normals (one for each position, or none), triangles by position index.
struct DracoPiece {
    std::span<const GridPoint> positions;
    std::span<const std::array<float, 3>> normals;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    int exponent = 0;
    std::span<const std::uint16_t> features = {};  ///< each the same for every vertex
};

/// What KHR_draco_mesh_compression has to say about a buffer view.
struct DracoBytes {
    std::string bytes;
    unsigned position_bits = 0;
    std::size_t points = 0;     ///< as decoded: Draco splits a vertex where two fans touch
    std::size_t triangles = 0;  ///< as decoded
    int position_id = 0;        ///< unique id of POSITION
    std::optional<int> normal_id;
    std::vector<int> feature_ids;  ///< unique ids, one for each feature
};

/// 7 of 10: as small as 5 and 30 % faster on a million triangles.
inline constexpr int kDracoSpeed = 7;
/// Octahedral normals, about a tenth of a degree.
inline constexpr int kDracoNormalBits = 10;

/// Encodes with EdgeBreaker. Every position decodes to exactly step * n in float32, in the order
/// that Draco chooses; the same input gives the same bytes.
/// Requires, because Draco's encoder checks nothing of it: at least one triangle, corners distinct
/// and in range, every position used; the positions' box within kDracoSteps on each axis; all
/// |positions| <= kFloatSteps. Cost: about 0.2 s for a million triangles on one thread, but never
/// below a millisecond where there are many bits: Draco counts symbols in a table of 2^bits.
std::variant<DracoBytes, EncodeError> encode_draco(const DracoPiece& piece);

}  // namespace tinsmith::api
