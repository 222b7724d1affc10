// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"

namespace tinsmith::core {

/// The only code that changes a TIN's triangles. Each change is drawn where it is defined, keeps
/// laws 2-4 of `Tin`, and is recorded so that the whole operation can be taken back.
/// Law 1 (strictly counter-clockwise) is the caller's to check before the change.
/// A Surgery lives for one operation on one mesh; end it with `commit` or `roll_back`.
class Surgery {
  public:
    explicit Surgery(Tin& tin);
    Surgery(const Surgery&) = delete;
    Surgery& operator=(const Surgery&) = delete;
    /// Rolls back unless committed.
    ~Surgery();

    /// Makes room to record about so many new vertices.
    void expect(std::size_t vertices);

    const Tin& tin() const { return tin_; }
    const UndoRecord& record() const { return record_; }

    /// Splits a triangle in three at a point strictly inside. New slots: 1 vertex, 2 triangles.
    VertexId split_triangle(TriangleId t, const Point3& p);
    /// Splits an edge, and the triangle or triangles beside it, at a point strictly between its
    /// ends. Both halves keep every mark. New slots: 1 vertex, 2 triangles (boundary: 1).
    VertexId split_edge(Side s, const Point3& p);
    /// Like `split_edge` for a way that comes from the apex c of `s` and goes on across it: the new
    /// edge c-p is a fresh constraint, locked where asked. Of the halves across, which share the
    /// apex d, the one that the way enters gets the new slot, so that no triangle is touched that
    /// the way does not meet; `past_a`: it is the half beside the origin of `s`.
    /// Requires: the edge is between facets, neither constrained nor locked nor on the boundary.
    /// New slots: 1 vertex, the half behind beside the destination of `s`, and the half that the
    /// way enters, in this order.
    VertexId split_and_pass(Side s, const Point3& p, bool past_a, bool lock);
    /// Exchanges the diagonal of the two triangles beside the edge. Requires: not a boundary edge.
    /// The triangle of `s` and its twin keep their slots. Returns a side of the new edge, whose
    /// triangle holds the old origin of `s`.
    Side swap_edge(Side s);
    /// Takes the apex of `s` onto the edge: the needle between them goes to the facet across.
    /// The edge a-b becomes a-apex-b with all its marks. Requires: not a boundary edge.
    void absorb_apex(Side s);

    /// Marks the edge on both sides as a constraint, and as fresh when it was none before.
    void mark_constrained(Side s);
    /// Locks the edge, or unlocks it, on both sides: a locked edge is never swapped; it may be
    /// split, and then both halves are locked.
    void set_locked(Side s, bool locked);
    /// True where the constraint was made by this operation and not before.
    bool is_fresh(Side s) const;

    /// Moves a vertex up or down. The facets around it are the caller's to renew.
    void set_elevation(VertexId v, double z);

    /// Takes triangles out, and vertices that no triangle is left of. Where a vertex is left
    /// between two fans or more, each further one gets a copy of it, appended, of the same name.
    /// Then the last slot goes into each gap, from the lowest on. Cost: linear in the mesh, with
    /// little for each triangle that stays; what is kept to take it back: what goes, and the
    /// boundary. Requires: nothing else was changed by this surgery; each triangle is named once,
    /// in order of slot; one is left at least.
    struct Removed {
        std::size_t vertices = 0;  ///< that are gone
        std::size_t copies = 0;    ///< that came
    };
    Removed remove(std::span<const TriangleId> triangles);

    /// Notes that vertices of a facet may be this far off its plane.
    void raise_facet_error(double error);

    /// Gives the triangle a facet of its own, newer than all others: it is no longer known to lie
    /// in one plane with a neighbour. Requires: fewer than kMaxFacets were made.
    FacetId give_fresh_facet(TriangleId t);

    /// Keeps the changes; what is returned can take them back (`undo`).
    UndoRecord commit();
    /// Takes all changes back, bit for bit.
    void roll_back();
    /// Takes a committed operation back. Requires: it is the newest on this mesh.
    static void undo(Tin& tin, const UndoRecord& record);
    /// The same for a record that is not needed any more: nothing is copied, so that it cannot fail
    /// for want of memory. Requires: the mesh was not copied since; no other holds the record.
    static void undo(Tin& tin, UndoRecord&& record) noexcept;

    /// Bits of `Tin::Triangle::marks` that live only while an operation runs.
    /// A triangle that is new or is in the record.
    static constexpr std::uint32_t kLoggedBit = 1U << 31;
    static constexpr unsigned kFreshShift = 8;
    static constexpr unsigned kInsideShift = 12;
    static constexpr std::uint32_t kTransientBits = kLoggedBit | (7U << kFreshShift);
    /// The bits of side 0 in `marks`; side i has them shifted left by i.
    static constexpr std::uint32_t kSideBits =
        1U | (1U << 4) | (1U << kFreshShift) | (1U << kInsideShift);

  private:
    friend class Removal;
    static void restore(Tin& tin, const UndoRecord& record, BoundaryIndex&& boundary,
                        std::vector<TriangleId>&& components);
    Tin::Triangle& edit(TriangleId t);
    Tin::Vertex& edit(VertexId v);
    void link(Side s, Side to);
    void renew_inside(TriangleId t, TriangleId u);
    VertexId append(const Point3& p, TriangleId t);
    TriangleId next_triangle() const;
    void append(VertexId v0, VertexId v1, VertexId v2, Side s0, Side s1, Side s2, FacetId facet,
                std::uint32_t marks);

    Tin& tin_;
    UndoRecord record_;
    bool bounds_are_stale_ = false;  ///< a vertex that was highest or lowest has moved
    bool open_ = true;
};

/// Keeps a copy of the triangle as it was, if it is an old one that was not changed before.
inline Tin::Triangle& Surgery::edit(TriangleId t) {
    Tin::Triangle& triangle = tin_.triangles_[t.index()];
    if ((triangle.marks & kLoggedBit) == 0) {  // new ones have it from the start
        record_.triangles.emplace_back(t, triangle);
        triangle.marks |= kLoggedBit;
    }
    return triangle;
}

inline Tin::Vertex& Surgery::edit(VertexId v) {
    Tin::Vertex& vertex = tin_.vertices_[v.index()];
    if (v.index() < record_.vertex_count) record_.vertices.emplace_back(v, vertex);
    return vertex;
}

}  // namespace tinsmith::core
