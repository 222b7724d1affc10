// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// Lines given by their positions, as constraints of a mesh.
class Breaklines {
  public:
    /// Takes a line whole, or not at all: where each position is a vertex's to the last bit, and
    /// each step is an edge of a triangle. False: it is not such a line. Edges of the mesh are
    /// looked up in a table made at the first line. Requires: the mesh stays as it is but for
    /// constraints.
    bool take(std::span<const core::Point3> line);

    explicit Breaklines(core::MeshData& mesh) : mesh_(mesh) {}

  private:
    void make_tables();
    std::uint32_t vertex_at(const core::Point3& position) const;
    bool has_edge(std::uint32_t a, std::uint32_t b) const;

    core::MeshData& mesh_;
    std::vector<std::uint32_t> by_position_;           ///< vertices, sorted by x, y, z
    std::vector<std::array<std::uint32_t, 2>> edges_;  ///< sorted, the smaller end first
    std::vector<std::array<std::uint32_t, 2>> of_a_line_;
};

}  // namespace tinsmith::api
