// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/formats/quantization.hpp"

namespace tinsmith::api {

/// The filter "EXPONENTIAL" of EXT_meshopt_compression holds a signed mantissa of 24 bits: whole
/// numbers of steps up to this magnitude decode to exactly step * n in float32, in every decoder.
inline constexpr std::int32_t kMeshoptSteps = (std::int32_t{1} << 23) - 1;

/// One compressed buffer view, as the extension tells of it.
struct MeshoptView {
    std::string bytes;
    std::size_t count = 0;
    std::size_t stride = 0;       ///< bytes of an element once it is decoded
    bool is_triangles = false;    ///< mode TRIANGLES; else ATTRIBUTES
    bool is_exponential = false;  ///< filter EXPONENTIAL; else none
};

/// One triangle mesh for meshopt, as DracoPiece. |positions| <= kFloatSteps.
struct MeshoptPiece {
    std::span<const GridPoint> positions;
    std::span<const std::array<float, 3>> normals;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    int exponent = 0;
    std::span<const std::uint16_t> features = {};  ///< each the same for every vertex
};

struct MeshoptBytes {
    MeshoptView positions;              ///< float32, three to an element
    std::vector<MeshoptView> normals;   ///< float32, likewise; none or one
    std::vector<MeshoptView> features;  ///< 16 bits and 16 of padding, one for each
    MeshoptView indices;                ///< 32 bits
};

/// Encodes with triangles and vertices in the order that is good for a GPU's caches. A triangle may
/// begin with another corner, and turns the same way. Every position decodes to exactly step * n;
/// normals to within 2^-13 on each axis. The same input gives the same bytes with the same library.
/// Requires: at least one triangle, indices in range, every position used.
/// Cost: about 0.2 s for a million triangles.
MeshoptBytes encode_meshopt(const MeshoptPiece& piece);

}  // namespace tinsmith::api
