// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A Delaunay triangulation that grows by a point at a time (Bowyer 1981, Watson 1981).
///
/// Laws: every edge of the hull has a ghost on its outer side, a triangle whose third vertex is
/// kGhost, so that each side of each triangle has a twin; triangles are counter-clockwise, a ghost
/// (u, v, kGhost) with what is outside on the left of u -> v; no vertex is inside the circle of a
/// triangle, exactly. Of four points on a circle that diagonal stays that was there first.
/// Cost of an insertion: the triangles on the way from the last one, and those it replaces.
/// Several may grow at the same time: none shares a cache line with another.
class alignas(64) GrowingDelaunay {
  public:
    static constexpr std::uint32_t kGhost = UINT32_MAX;

    /// Side i runs from vertex i to vertex i + 1; the last number of each is not used, so that
    /// a triangle never lies across two cache lines. Twins are 4 * triangle + side.
    struct alignas(32) Triangle {
        std::array<std::uint32_t, 4> vertices;
        std::array<std::uint32_t, 4> twins;

        bool is_ghost() const {
            return vertices[0] == kGhost || vertices[1] == kGhost || vertices[2] == kGhost;
        }
    };

    /// Which points and which slots for triangles are its own.
    struct Share {
        std::size_t first_point;
        std::size_t first_triangle;
    };

    /// With its first three points. It needs two slots less than twice as many as its points.
    /// Requires: the three are not on one line; points are distinct and fewer than 2^29; points and
    /// slots live as long as this.
    GrowingDelaunay(std::span<const Point2> points, Triangle* triangles, Share share);

    /// Requires: `point` is an index into the points, one of its own that was not inserted yet and
    /// is not one of its first three.
    void insert(std::uint32_t point);

  private:
    /// A side of the hole that a new point makes, with the triangle outside of it.
    struct Rim {
        std::uint32_t outer;   ///< the outer triangle's side
        std::uint32_t origin;  ///< where the side starts, going round the hole to the left
    };

    std::uint32_t find(Point2 p) const;
    bool is_replaced_by(std::uint32_t triangle, Point2 p) const;
    void dig(std::uint32_t triangle, Point2 p);
    void fill(std::uint32_t point);

    std::span<const Point2> points_;
    Triangle* triangles_;
    std::size_t end_;     ///< the first slot that is free
    std::uint32_t last_;  ///< a triangle with the newest point, no ghost
    std::vector<std::uint32_t> stack_;
    std::vector<std::uint32_t> hole_;  ///< the triangles that go
    std::vector<Rim> rim_;
};

}  // namespace tinsmith::core
