// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/mesh_data.hpp"

namespace tinsmith::verify {

inline constexpr std::uint32_t kNone = UINT32_MAX;

/// One corner of a triangle, seen from its vertex v: the triangle's edges are v -> next,
/// next -> last, last -> v.
struct Corner {
    std::uint32_t next;
    std::uint32_t last;
    std::uint32_t triangle;
};

/// The corners around each vertex of a mesh, by `next`: which triangle has the edge a -> b.
/// Requires: all indices are in range.
class Stars {
  public:
    explicit Stars(const core::MeshData& mesh);

    std::span<const Corner> around(std::uint32_t v) const {
        return {corners_.data() + first_[v], first_[v + 1] - first_[v]};
    }
    /// The triangle with the directed edge a -> b, or kNone.
    std::uint32_t triangle_of(std::uint32_t a, std::uint32_t b) const;

  private:
    std::vector<std::size_t> first_;
    std::vector<Corner> corners_;
};

/// The triangles of a mesh in a grid of flat buckets, to find those near a box.
class TriangleGrid {
  public:
    explicit TriangleGrid(const core::MeshData& mesh);

    const core::MeshData& mesh() const { return *mesh_; }
    core::Point2 min() const { return min_; }
    core::Point2 max() const { return max_; }
    /// 4 ulp of the largest plan coordinate: what rounding may move a vertex.
    double rounding_reach() const { return reach_; }
    double extent() const;

    /// Calls `visit` with each triangle whose box meets the box, some of them more than once.
    template <typename Visit>
    void near(core::Point2 low, core::Point2 high, const Visit& visit) const {
        const std::size_t right = column(high.x), top = row(high.y);
        for (std::size_t r = row(low.y); r <= top; ++r) {
            for (std::size_t c = column(low.x); c <= right; ++c) {
                const std::size_t cell = r * columns_ + c;
                for (std::size_t i = first_[cell]; i < first_[cell + 1]; ++i) {
                    const Box& box = boxes_[entries_[i]];
                    if (box.low.x <= high.x && box.high.x >= low.x && box.low.y <= high.y &&
                        box.high.y >= low.y)
                        visit(entries_[i]);
                }
            }
        }
    }

    /// The triangle that holds p, edges included, exactly; kNone outside.
    std::uint32_t triangle_at(core::Point2 p) const;
    /// Whether a triangle is at most `reach` from p, or with a negative reach, holds p so far
    /// within its edges.
    bool holds(core::Point2 p, double reach) const;

    std::array<core::Point2, 3> corners(std::uint32_t t) const {
        const auto& [a, b, c] = mesh_->triangles[t];
        return {mesh_->vertices[a].plan(), mesh_->vertices[b].plan(), mesh_->vertices[c].plan()};
    }

  private:
    struct Box {
        core::Point2 low;
        core::Point2 high;
    };
    std::size_t cell_of(double offset, double width) const;
    std::size_t column(double x) const { return cell_of(x - min_.x, max_.x - min_.x); }
    std::size_t row(double y) const { return cell_of(y - min_.y, max_.y - min_.y); }

    const core::MeshData* mesh_;
    core::Point2 min_;
    core::Point2 max_;
    double reach_ = 0.0;
    std::size_t columns_ = 1;
    std::vector<Box> boxes_;
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> entries_;
};

}  // namespace tinsmith::verify
