// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/boundary_index.hpp"
#include "core/mesh/line_allocator.hpp"
#include "core/types/ids.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// Axis-aligned box around all vertices, in the session's unit.
struct Bounds {
    Point3 min;
    Point3 max;
};

/// A constrained edge a-b that became a-p-b.
struct ConstraintSplit {
    VertexId a;
    VertexId b;
    VertexId p;
};

/// A vertex at which a constrained edge ended that was removed.
struct GoneEnd {
    VertexId name;
    Point2 plan;
};

/// A 2.5D triangulation: one elevation for each plan position of its domain, which may be
/// concave, have holes, and consist of several components.
///
/// What always holds (each line is a check in `check_tin`):
///   1. every triangle is strictly counter-clockwise in plan, by the exact predicate;
///   2. adjacency is symmetric: the twin of a side's twin is the side;
///   3. a vertex's triangle contains it; every vertex has one, and one fan of triangles only;
///   4. both sides of an edge carry the same marks, and say rightly whether it is inside a facet;
///   5. all coordinates are finite and within kCoordinateLimit.
///
/// Local numbering, for the whole library:
///
///              v2
///             /  \            side i runs from vertex i to vertex (i+1) mod 3;
///     side 2 /    \ side 1    twins[i] is the other side of that edge,
///           /      \          invalid on the boundary.
///         v0 ------ v1
///            side 0
///
/// Slots are stable but for removals: everything else appends and rewrites. A removal moves the
/// last slot into each gap; so that lines can be followed beyond it, vertices have names, too (see
/// `name`).
/// Memory: 32 bytes a vertex and 32 bytes a triangle, about 48 bytes a triangle in all.
/// Source: Stanchev & Paraskevov 2023, section 3.1, with indices for pointers and twins for
/// neighbours.
class Tin {
  public:
    struct Vertex {
        double x = 0.0;
        double y = 0.0;
        double z = 0.0;
        TriangleId triangle;  ///< any one triangle around the vertex

        Point2 plan() const { return {x, y}; }
        Point3 point() const { return {x, y, z}; }
    };

    struct Triangle {
        std::array<VertexId, 3> vertices;
        std::array<Side, 3> twins;
        FacetId facet;
        /// Bit i: side i is constrained; bit 4 + i: it is locked; bit 12 + i: it is inside a facet,
        /// the triangle across lies in the same one.
        std::uint32_t marks = 0;

        friend bool operator==(const Triangle&, const Triangle&) = default;
    };

    std::size_t vertex_count() const { return vertices_.size(); }
    std::size_t triangle_count() const { return triangles_.size(); }

    const Vertex& vertex(VertexId id) const { return vertices_[id.index()]; }
    const Triangle& triangle(TriangleId id) const { return triangles_[id.index()]; }
    Point2 plan(VertexId id) const { return vertices_[id.index()].plan(); }

    VertexId origin(Side s) const { return triangle(s.triangle()).vertices[s.index()]; }
    VertexId destination(Side s) const {
        return triangle(s.triangle()).vertices[Side::next_of(s.index())];
    }
    /// The vertex across from the side, in the side's triangle.
    VertexId apex(Side s) const {
        return triangle(s.triangle()).vertices[Side::previous_of(s.index())];
    }
    /// The same edge seen from the other triangle; invalid on the boundary.
    Side twin(Side s) const { return triangle(s.triangle()).twins[s.index()]; }
    bool is_constrained(Side s) const {
        return ((triangle(s.triangle()).marks >> s.index()) & 1U) != 0;
    }
    bool is_locked(Side s) const {
        return ((triangle(s.triangle()).marks >> (s.index() + 4)) & 1U) != 0;
    }
    FacetId facet(TriangleId id) const { return triangle(id).facet; }
    /// The value of the next facet to be made; all that are there have lower ones.
    std::uint32_t next_facet() const { return next_facet_; }

    /// True where a swap may not touch the edge whatever the mode: boundary, constrained, locked.
    bool is_fixed(Side s) const { return !twin(s).valid() || is_constrained(s) || is_locked(s); }
    /// True where the surface may bend along the edge: its triangles lie in different facets, or it
    /// has only one. Like all marks, it takes no look at the triangle across.
    bool separates_facets(Side s) const {
        return ((triangle(s.triangle()).marks >> (s.index() + 12)) & 1U) == 0;
    }
    /// True where a swap moves nothing and nothing forbids it: inside a facet, neither constrained
    /// nor locked.
    bool is_free(Side s) const {
        return ((triangle(s.triangle()).marks >> s.index()) & 0x1011U) == 0x1000U;
    }

    /// Certified: no vertex is farther above or below the plane of a facet around it, session unit.
    /// Zero while no operation has put more triangles than one into a facet.
    double facet_error() const { return facet_error_; }
    /// Vertices with lower ids were there when the mesh was built. A triangle of three of them is
    /// the whole of its facet.
    std::size_t built_vertex_count() const { return built_vertex_count_; }

    /// Box around the vertices. Cost: O(1).
    const Bounds& bounds() const { return bounds_; }

    const BoundaryIndex& boundary() const { return boundary_; }
    /// One triangle of each component, in order of slot. No operation but a removal parts
    /// components or takes a triangle's slot to another, so they are found when the mesh is built
    /// and after each removal.
    const std::vector<TriangleId>& components() const { return components_; }
    /// A triangle somewhere near the position, to start a walk at. Cost: O(1).
    TriangleId hint(Point2 p) const { return hints_[hint_cell(p)]; }
    /// Where `hint` is kept, for those who want to ask for it ahead of time.
    const TriangleId* hint_place(Point2 p) const { return &hints_[hint_cell(p)]; }

    /// What the vertex is called in chains and, from the next removal on, in constraint splits: the
    /// slot that it had while nothing was removed; later ones go on counting. A name stays with the
    /// vertex, and is never given again; copies of a vertex that a removal made share its name.
    VertexId name(VertexId v) const { return names_.empty() ? v : names_[v.index()]; }
    /// Whether names may differ from slots: anything was ever removed.
    bool is_renumbered() const { return !names_.empty(); }
    /// How many names were given.
    std::size_t name_count() const { return names_.empty() ? vertices_.size() : next_name_; }
    /// Where the ends of constrained edges are, or were, that removals took away.
    const std::vector<GoneEnd>& gone_ends() const { return gone_ends_; }

    /// All constrained edges that were split since the mesh was built, oldest first: what leads
    /// from a chain as it was integrated to the edges that make it up now. The first
    /// `named_split_count()` are told by name, those since the last removal by slot.
    const std::vector<ConstraintSplit>& constraint_splits() const { return constraint_splits_; }
    std::size_t named_split_count() const { return named_splits_; }

    /// Plain copies of vertices, triangles and constrained edges, in slot order. Cost: linear.
    MeshData to_data() const;

    /// Bytes that the mesh holds, growth room that was never touched left out.
    std::size_t memory_bytes() const;

    /// A copy has room to grow like the original, so that its first edit need not move it.
    Tin(const Tin& other);
    Tin& operator=(const Tin& other);
    Tin(Tin&&) = default;
    Tin& operator=(Tin&&) = default;

  private:
    Tin() = default;
    /// Takes address space for half as many slots again; memory only where they are used.
    void reserve_growth(std::size_t vertices, std::size_t triangles);

    BoundaryIndex index_boundary() const;
    /// Of these sides, which are all that have no twin, in order.
    BoundaryIndex index_boundary(std::span<const Side> sides) const;
    /// About one hint for three triangles, over the bounds; none is there yet.
    void lay_out_hints();
    /// Cells without a triangle's centroid take the hint before them.
    void fill_hints();

    std::size_t hint_cell(Point2 p) const {
        return hint_row(p.y) * hint_columns_ + hint_column(p.x);
    }
    std::size_t hint_row(double y) const { return hint_of((y - hint_origin_.y) * hints_per_y_); }
    std::size_t hint_column(double x) const { return hint_of((x - hint_origin_.x) * hints_per_x_); }
    std::size_t hint_of(double place) const {
        const double last = static_cast<double>(hint_columns_ - 1);
        return static_cast<std::size_t>(place > 0.0 ? std::min(last, place) : 0.0);
    }

    friend class TinBuilder;
    friend class GridBuilder;
    friend class Surgery;
    friend class Removal;
    friend struct TinState;

    std::vector<Vertex, LineAllocator<Vertex>> vertices_;
    std::vector<Triangle, LineAllocator<Triangle>> triangles_;
    std::vector<ConstraintSplit> constraint_splits_;
    std::size_t named_splits_ = 0;
    std::vector<VertexId> names_;  ///< of each slot; empty: the slots themselves
    std::uint32_t next_name_ = 0;  ///< where there are names
    std::vector<GoneEnd> gone_ends_;
    std::uint32_t next_facet_ = 0;
    double facet_error_ = 0.0;
    std::size_t built_vertex_count_ = 0;
    Bounds bounds_;
    BoundaryIndex boundary_;
    std::vector<TriangleId> components_;
    std::vector<TriangleId> hints_;  ///< square grid over the bounds as built, row by row
    Point2 hint_origin_;
    std::size_t hint_columns_ = 0;
    double hints_per_x_ = 0.0;
    double hints_per_y_ = 0.0;
};

static_assert(sizeof(Tin::Vertex) == 32 && sizeof(Tin::Triangle) == 32);

}  // namespace tinsmith::core
