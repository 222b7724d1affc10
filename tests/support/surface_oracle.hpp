// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

/// A mesh as plain triangles in a grid of buckets: finds the triangle at a position and its
/// elevation by its own arithmetic, so that tests do not ask the core about the core.
class SurfaceOracle {
  public:
    explicit SurfaceOracle(const core::MeshData& mesh);

    /// A triangle that holds the position, to within `slack` of its edges; the innermost of those.
    std::optional<std::uint32_t> triangle_at(core::Point2 p, double slack) const;
    /// Elevation of the plane of triangle t at p.
    double elevation(std::uint32_t t, core::Point2 p) const;
    /// Steepest slope of triangle t.
    double slope(std::uint32_t t) const;

    const core::MeshData& mesh() const { return mesh_; }
    core::Point2 min() const { return min_; }
    core::Point2 max() const { return max_; }

  private:
    std::size_t column(double x) const;
    std::size_t row(double y) const;

    core::MeshData mesh_;
    core::Point2 min_;
    core::Point2 max_;
    std::size_t columns_ = 1;
    std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace tinsmith::test
