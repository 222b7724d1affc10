// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::bench {

/// A mesh as the codecs take it: float32 positions on Tinsmith's grid and normals, in glTF's axes,
/// vertices numbered by first use. All that a writer of GLB must do before and after is left out.
struct ReadyBuffers {
    explicit ReadyBuffers(const core::MeshData& mesh);

    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::array<std::int32_t, 3> low{};  ///< of the positions, in steps
    std::int32_t extent = 1;            ///< the widest axis, in steps
    int exponent = 0;                   ///< a step is 2^exponent
};

/// Draco alone: its mesh is filled, and what is asked for is the encoding.
class DracoAlone {
  public:
    explicit DracoAlone(const ReadyBuffers& buffers);
    ~DracoAlone();

    /// Bytes made, with the settings of `encode_draco`.
    std::size_t encode() const;

  private:
    struct Filled;
    std::unique_ptr<Filled> filled_;
};

/// meshopt alone: its filter's numbers are there.
class MeshoptAlone {
  public:
    explicit MeshoptAlone(const ReadyBuffers& buffers);

    /// Bytes made by its own calls, in the order that its makers advise: cache, fetch, codecs.
    std::size_t encode() const;

  private:
    using Exponentials = std::vector<std::array<std::uint32_t, 3>>;

    const ReadyBuffers& buffers_;
    Exponentials positions_;
    Exponentials normals_;
};

}  // namespace tinsmith::bench
