// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/surgery.hpp"

#include <algorithm>
#include <utility>

#include "core/types/chosen.hpp"

namespace tinsmith::core {

namespace {

unsigned next_of(unsigned i) {
    return Side::next_of(i);
}

unsigned previous_of(unsigned i) {
    return Side::previous_of(i);
}

/// The marks of side `from` alone, moved to side `to`.
std::uint32_t side_marks(std::uint32_t marks, unsigned from, unsigned to) {
    return ((marks >> from) & Surgery::kSideBits) << to;
}

constexpr std::uint32_t kInsideBit = 1U << Surgery::kInsideShift;

/// The marks of side `i` alone, inside a facet.
std::uint32_t inside(unsigned i) {
    return kInsideBit << i;
}

void set_side_marks(std::uint32_t& marks, unsigned side, std::uint32_t moved) {
    marks = (marks & ~(Surgery::kSideBits << side)) | moved;
}

}  // namespace

/// Makes `to` the twin of `s`, which may be invalid.
inline void Surgery::link(Side s, Side to) {
    if (s.valid()) edit(s.triangle()).twins[s.index()] = to;
}

inline VertexId Surgery::append(const Point3& p, TriangleId t) {
    const VertexId id{static_cast<std::uint32_t>(tin_.vertices_.size())};
    Tin::Vertex& vertex = tin_.vertices_.emplace_back();
    vertex.x = p.x;
    vertex.y = p.y;
    vertex.z = p.z;
    vertex.triangle = t;
    if (!tin_.names_.empty()) tin_.names_.push_back({tin_.next_name_++});
    return id;
}

/// The slot that `append` fills next.
inline TriangleId Surgery::next_triangle() const {
    return {static_cast<std::uint32_t>(tin_.triangles_.size())};
}

/// Written part by part where it stays: one that is built aside and copied is read back before its
/// parts have arrived. References to triangles are void afterwards.
inline void Surgery::append(VertexId v0, VertexId v1, VertexId v2, Side s0, Side s1, Side s2,
                            FacetId facet, std::uint32_t marks) {
    Tin::Triangle& triangle = tin_.triangles_.emplace_back();
    triangle.vertices[0] = v0;
    triangle.vertices[1] = v1;
    triangle.vertices[2] = v2;
    triangle.twins[0] = s0;
    triangle.twins[1] = s1;
    triangle.twins[2] = s2;
    triangle.facet = facet;
    triangle.marks = marks | kLoggedBit;
}

//            v2                        T  keeps its slot: (v0, v1, p)
//           /|\                        A  new:            (v1, v2, p)
//          / | \                       B  new:            (v2, v0, p)
//      n2 /  |  \ n1
//        / B p A \                     n0, n1, n2: the sides across, unchanged
//       /  /   \  \                    new edges: p-v0, p-v1, p-v2, unmarked
//      / /   T   \ \                   .
//     v0 ---------- v1
//            n0
VertexId Surgery::split_triangle(TriangleId t, const Point3& point) {
    Tin::Triangle& T = edit(t);
    const auto [v0, v1, v2] = T.vertices;
    const Side n1 = T.twins[1];
    const Side n2 = T.twins[2];
    const std::uint32_t marks = T.marks;
    const FacetId facet = T.facet;

    const std::uint32_t within = inside(1) | inside(2);
    const VertexId p = append(point, t);
    T.vertices[2] = p;
    set_side_marks(T.marks, 1, inside(1));
    set_side_marks(T.marks, 2, inside(2));
    const TriangleId A = next_triangle();
    const TriangleId B{A.value + 1};
    T.twins[1] = {A, 2};
    T.twins[2] = {B, 1};
    append(v1, v2, p, n1, {B, 2}, {t, 1}, facet, side_marks(marks, 1, 0) | within);
    append(v2, v0, p, n2, {t, 2}, {A, 1}, facet, side_marks(marks, 2, 0) | within);
    link(n1, {A, 0});
    link(n2, {B, 0});
    if (tin_.vertex(v2).triangle == t) edit(v2).triangle = A;
    return p;
}

//            c                         T (a, b, c) keeps its slot: (a, p, c)
//           /|\                        U (b, a, d) keeps its slot: (b, p, d)
//          / | \                       N new: (p, b, c)
//         /  |  \                      M new: (p, a, d)
//        / T | N \                     .
//       a ---p--- b    s = a -> b      both halves keep the marks of a-b;
//        \ M | U /                     new edges p-c, p-d unmarked
//         \  |  /                      .
//          \ | /                       on the boundary there is no U and no M
//           \|/
//            d
VertexId Surgery::split_edge(Side s, const Point3& point) {
    const TriangleId t = s.triangle();
    const unsigned i = s.index();
    const unsigned i1 = next_of(i);
    const Side across = tin_.twin(s);

    Tin::Triangle& T = edit(t);
    const VertexId a = T.vertices[i];
    const VertexId b = T.vertices[i1];
    const VertexId c = T.vertices[previous_of(i)];
    const std::uint32_t marks = T.marks;
    const FacetId facet = T.facet;
    const Side outer_bc = T.twins[i1];

    const VertexId p = append(point, t);
    if ((marks >> i & 1U) != 0) tin_.constraint_splits_.push_back({a, b, p});
    T.vertices[i1] = p;
    set_side_marks(T.marks, i1, inside(i1));
    const TriangleId N = next_triangle();
    const std::uint32_t marks_n = side_marks(marks, i, 0) | side_marks(marks, i1, 1) | inside(2);
    T.twins[i1] = {N, 2};
    if (tin_.vertex(b).triangle == t) edit(b).triangle = N;

    if (!across.valid()) {
        append(p, b, c, {}, outer_bc, {t, i1}, facet, marks_n);
        link(outer_bc, {N, 1});
        tin_.boundary_.add_split(a, tin_.plan(a), p, point.plan(), tin_.plan(b));
        return p;
    }

    const TriangleId M{N.value + 1};
    T.twins[i] = {M, 0};
    link(outer_bc, {N, 1});

    const TriangleId u = across.triangle();
    const unsigned j = across.index();
    const unsigned j1 = next_of(j);
    Tin::Triangle& U = edit(u);
    const VertexId d = U.vertices[previous_of(j)];
    const std::uint32_t marks_u = U.marks;
    const FacetId facet_u = U.facet;
    const Side outer_ad = U.twins[j1];

    U.vertices[j1] = p;
    set_side_marks(U.marks, j1, inside(j1));
    U.twins[j] = {N, 0};
    U.twins[j1] = {M, 2};
    link(outer_ad, {M, 1});
    append(p, b, c, across, outer_bc, {t, i1}, facet, marks_n);
    append(p, a, d, s, outer_ad, {u, j1}, facet_u,
           side_marks(marks_u, j, 0) | side_marks(marks_u, j1, 1) | inside(2));
    if (tin_.vertex(a).triangle == u) edit(a).triangle = M;
    return p;
}

//            c                         T (a, b, c) keeps its slot: (a, p, c)
//           /|\                        N new: (p, b, c)
//          / | \                       .
//         /  |  \                      past a:  M new: (p, a, d), U keeps its slot: (b, p, d)
//        / T | N \                     past b:  M new: (b, p, d), U keeps its slot: (p, a, d)
//       a ---p--- b    s = a -> b      .
//        \   |   /                     c-p is the way: constrained
//         \  |  /                      p-d unmarked
//          \ | /                       .
//            d
VertexId Surgery::split_and_pass(Side s, const Point3& point, bool past_a, bool lock) {
    const TriangleId t = s.triangle();
    const unsigned i = s.index();
    const unsigned i1 = next_of(i);
    Tin::Triangle& T = edit(t);
    const Side across = T.twins[i];
    const TriangleId u = across.triangle();
    const unsigned j = across.index();
    const unsigned j1 = next_of(j);
    const unsigned j2 = previous_of(j);
    Tin::Triangle& U = edit(u);
    const VertexId a = T.vertices[i];
    const VertexId b = T.vertices[i1];
    const VertexId c = T.vertices[previous_of(i)];
    const VertexId d = U.vertices[j2];
    const TriangleId N = next_triangle();
    const TriangleId M{N.value + 1};
    const FacetId facet = T.facet, facet_u = U.facet;
    const Side outer_bc = T.twins[i1];
    const std::uint32_t marks_bc = side_marks(T.marks, i1, 1);
    const std::uint32_t way = kInsideBit | 1U | (1U << kFreshShift) | (lock ? 1U << 4 : 0U);

    // Which half is entered is a coin's toss: all is chosen, nothing branched for.
    const unsigned lost = chosen(past_a, j1, j2);  // U's side that goes to M
    const unsigned turn = past_a ? 2U : 1U;        // M's side that is p-d
    const Side outer = U.twins[lost];
    const std::uint32_t marks_lost = side_marks(U.marks, lost, 3 - turn);
    const VertexId beside = chosen(past_a, a, b);

    const VertexId p = append(point, t);
    T.vertices[i1] = p;
    T.twins[i1] = {N, 2};
    T.twins[i] = chosen(past_a, Side{M, 0}, across);
    set_side_marks(T.marks, i1, way << i1);
    U.vertices[chosen(past_a, j1, j)] = p;
    U.twins[lost] = {M, turn};
    U.twins[j] = chosen(past_a, Side{N, 0}, s);
    set_side_marks(U.marks, lost, inside(lost));
    if (tin_.vertex(b).triangle == t) edit(b).triangle = N;
    if (tin_.vertex(beside).triangle == u) edit(beside).triangle = M;
    link(outer_bc, {N, 1});
    link(outer, {M, 3 - turn});
    append(p, b, c, chosen(past_a, across, Side{M, 0}), outer_bc, {t, i1}, facet,
           marks_bc | way << 2);
    append(chosen(past_a, p, b), chosen(past_a, a, p), d, chosen(past_a, s, Side{N, 0}),
           chosen(past_a, outer, Side{u, lost}), chosen(past_a, Side{u, lost}, outer), facet_u,
           marks_lost | inside(turn));
    return p;
}

//          c                   c
//         / \                 /|\          T (a, b, c) becomes (a, d, c)
//        /   \               / | \         U (b, a, d) becomes (b, c, d)
//       /  T  \             /  |  \        .
//      a ----- b    ==>    a T | U b       s = a -> b
//       \  U  /             \  |  /        the outer edges a-d and b-c change owner
//        \   /               \ | /         and keep their marks; d-c is unmarked
//         \ /                 \|/
//          d                   d
Side Surgery::swap_edge(Side s) {
    const Side across = tin_.twin(s);
    const TriangleId t = s.triangle();
    const TriangleId u = across.triangle();
    const unsigned i = s.index();
    const unsigned i1 = next_of(i);
    const unsigned j = across.index();
    const unsigned j1 = next_of(j);

    Tin::Triangle& T = edit(t);
    Tin::Triangle& U = edit(u);
    const VertexId a = T.vertices[i];
    const VertexId b = T.vertices[i1];
    const VertexId c = T.vertices[previous_of(i)];
    const VertexId d = U.vertices[previous_of(j)];
    const Side outer_bc = T.twins[i1];
    const Side outer_ad = U.twins[j1];
    const std::uint32_t marks_bc = side_marks(T.marks, i1, j);
    const std::uint32_t marks_ad = side_marks(U.marks, j1, i);

    T.vertices[i1] = d;
    U.vertices[j1] = c;
    const bool is_inside = (T.marks & inside(i)) != 0;
    set_side_marks(T.marks, i, marks_ad);
    set_side_marks(T.marks, i1, is_inside ? inside(i1) : 0);
    set_side_marks(U.marks, j, marks_bc);
    set_side_marks(U.marks, j1, is_inside ? inside(j1) : 0);
    T.twins[i] = outer_ad;
    T.twins[i1] = {u, j1};
    U.twins[j] = outer_bc;
    U.twins[j1] = {t, i1};
    link(outer_ad, {t, i});
    link(outer_bc, {u, j});
    if (tin_.vertex(b).triangle == t) edit(b).triangle = u;
    if (tin_.vertex(a).triangle == u) edit(a).triangle = t;
    if (!is_inside) renew_inside(t, u);
    return {t, i1};
}

//          c                   c
//         / \                 /|\          the needle T (a, b, c) leaves its facet:
//        / T \               / | \         both triangles lie in U's facet afterwards;
//      a ----- b    ==>    a T | U b       a-c and c-b, now the border between the
//       \  U  /             \  |  /        facets, take the marks of a-b as well
//        \   /               \ | /
//          d                   d
void Surgery::absorb_apex(Side s) {
    const Side across = tin_.twin(s);
    const TriangleId t = s.triangle();
    const TriangleId u = across.triangle();
    const unsigned i = s.index();
    const std::uint32_t marks = tin_.triangle(t).marks;
    const FacetId facet = tin_.facet(u);

    if (tin_.is_constrained(s))
        tin_.constraint_splits_.push_back({tin_.origin(s), tin_.destination(s), tin_.apex(s)});
    swap_edge(s);  // T (a, d, c): c -> a is side i + 2; U (b, c, d): b -> c is side j
    edit(t).facet = facet;
    renew_inside(t, u);
    const auto add_marks = [this, marks, i](Side side) {
        const std::uint32_t moved = marks & ~inside(i);
        edit(side.triangle()).marks |= side_marks(moved, i, side.index());
        const Side other = tin_.twin(side);
        if (other.valid()) edit(other.triangle()).marks |= side_marks(moved, i, other.index());
    };
    add_marks({t, previous_of(i)});
    add_marks({u, across.index()});
}

void Surgery::mark_constrained(Side s) {
    if (tin_.is_constrained(s)) return;
    const auto mark = [this](Side side) {
        if (!side.valid()) return;
        edit(side.triangle()).marks |= (1U | (1U << kFreshShift)) << side.index();
    };
    mark(s);
    mark(tin_.twin(s));
}

void Surgery::set_locked(Side s, bool locked) {
    if (tin_.is_locked(s) == locked) return;
    for (const Side side : {s, tin_.twin(s)})
        if (side.valid()) edit(side.triangle()).marks ^= 1U << (side.index() + 4);
}

bool Surgery::is_fresh(Side s) const {
    return ((tin_.triangle(s.triangle()).marks >> (s.index() + kFreshShift)) & 1U) != 0;
}

void Surgery::set_elevation(VertexId v, double z) {
    double& elevation = edit(v).z;
    record_.moved_vertices = true;
    Bounds& box = tin_.bounds_;
    if (elevation == box.min.z || elevation == box.max.z) bounds_are_stale_ = true;
    elevation = z;
    box.min.z = std::min(box.min.z, z);
    box.max.z = std::max(box.max.z, z);
}

void Surgery::raise_facet_error(double error) {
    tin_.facet_error_ = std::max(tin_.facet_error_, error);
}

FacetId Surgery::give_fresh_facet(TriangleId t) {
    edit(t).facet = {tin_.next_facet_++};
    renew_inside(t, t);
    return tin_.facet(t);
}

/// After triangles came to other facets or other places: marks their edges on both sides as
/// inside a facet, or not.
void Surgery::renew_inside(TriangleId t, TriangleId u) {
    for (const TriangleId triangle : {t, u}) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(triangle, i);
            const Side across = tin_.twin(side);
            const bool is_inside =
                across.valid() && tin_.facet(triangle) == tin_.facet(across.triangle());
            if (is_inside != tin_.separates_facets(side)) continue;
            edit(triangle).marks ^= inside(i);
            if (across.valid()) edit(across.triangle()).marks ^= inside(across.index());
        }
    }
}

}  // namespace tinsmith::core
