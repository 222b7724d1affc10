// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/integrate/report.hpp"
#include "core/mesh/tin.hpp"
#include "core/regions/constraint_history.hpp"
#include "core/regions/region.hpp"

namespace tinsmith::core {

/// The caller's numbers of shapes, by the thing that they are on: few things of many have any.
template <typename Key>
class ShapesByKey {
  public:
    ShapesByKey() = default;
    /// Cost: n log n in the entries. An entry given twice counts once.
    explicit ShapesByKey(std::vector<std::pair<Key, std::size_t>> entries);

    /// The shapes in growing order; none where the key has none. Cost: log n.
    std::span<const std::size_t> of(Key key) const;
    /// Each key that has shapes, once for each of them, in order.
    const std::vector<Key>& keys() const { return keys_; }

  private:
    std::vector<Key> keys_;
    std::vector<std::size_t> shapes_;  ///< one for each of `keys_`
};

/// Which shapes run along which constrained edges: the shapes' lines, and what they share.
/// Of the mesh as it was when this was made.
class Linework {
  public:
    struct Lines {
        std::size_t shape = 0;  ///< the caller's number for it
        std::span<const Chain> chains;
    };
    /// Cost: n log n in the chains' edges.
    Linework(const ConstraintHistory& history, std::span<const Lines> lines);

    /// The shapes along the edge between two vertices, whichever way round.
    std::span<const std::size_t> along(VertexId a, VertexId b) const;
    std::span<const std::size_t> along(const Tin& tin, Side side) const;

  private:
    ShapesByKey<std::uint64_t> shapes_;
};

/// Which shapes contain which triangles: the polygon coverage of the mesh, with its overlaps.
/// Of the mesh as it was when the regions were found.
class Coverage {
  public:
    struct Area {
        std::size_t shape = 0;  ///< the caller's number for it
        const Region* region = nullptr;
    };
    /// Cost: n log n in the regions' triangles.
    explicit Coverage(std::span<const Area> areas);

    /// The shapes that contain the triangle.
    std::span<const std::size_t> containing(TriangleId t) const { return shapes_.of(t); }
    /// The triangles that any shape contains, once for each of them, in order of slot.
    const std::vector<TriangleId>& triangles() const { return shapes_.keys(); }

  private:
    ShapesByKey<TriangleId> shapes_;
};

}  // namespace tinsmith::core
