// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"

namespace tinsmith::cgal {

/// A path with elevations; a closed one ends with its first point again.
using Polyline = std::vector<core::Point3>;

/// CGAL's constrained Delaunay triangulation over the plan, by the two recipes one would use it
/// for. Polygon points become vertices, then each segment is inserted as a constraint.
/// Exact predicates; positions of intersections are rounded. CGAL's triangulations are GPL: tests
/// and benchmarks only.
class Peer {
  public:
    /// Recipe a: the mesh's points, triangulated anew. The surface moves.
    static Peer of_points(const core::MeshData& mesh);
    /// Recipe b: the mesh's own triangles, every edge a constraint, so that segments split edges
    /// and the surface stays. Elevations at intersections are the mesh edge's (CGAL's own are the
    /// mean of both). Between the mesh's outline and its convex hull, and in its holes, CGAL has
    /// triangles of its own, for its domain is always convex.
    static Peer of_triangles(const core::MeshData& mesh);

    Peer(const Peer& other);
    Peer(Peer&&) noexcept;
    Peer& operator=(const Peer&) = delete;
    ~Peer();

    /// Each path in order, each point looked for from the one before it.
    void insert(std::span<const Polyline> paths);

    std::size_t vertex_count() const;
    /// All vertices, in no order that means anything.
    std::vector<core::Point3> vertices() const;
    /// Whether CGAL finds its triangulation in order. Cost: linear.
    bool is_valid() const;
    /// Bytes of all vertex and face slots.
    std::size_t memory_bytes() const;

  private:
    struct Triangulation;
    explicit Peer(std::unique_ptr<Triangulation> triangulation);
    std::unique_ptr<Triangulation> triangulation_;
};

}  // namespace tinsmith::cgal
