// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/pair.hpp"

namespace tinsmith::core {

namespace {

/// From one vertex to another, in 3D.
struct Leg {
    double x, y, z;

    Leg(const Tin::Vertex& from, const Tin::Vertex& to)
        : x(to.x - from.x), y(to.y - from.y), z(to.z - from.z) {}
    double squared() const { return x * x + y * y + z * z; }
};

/// Twice the area in plan of a counter-clockwise triangle: the same double whichever of its
/// corners is named first.
double area_by_lowest_slot(const Tin& tin, VertexId a, VertexId b, VertexId c) {
    if (a < b && a < c) return doubled_area(tin.plan(b), tin.plan(c), tin.plan(a));
    if (b < c) return doubled_area(tin.plan(c), tin.plan(a), tin.plan(b));
    return doubled_area(tin.plan(a), tin.plan(b), tin.plan(c));
}

/// Grows with a triangle's smallest angle, by its area in plan and its squared edges in 3D; alike
/// for all triangles of a facet, which are foreshortened alike. Two values compare as the angles do
/// when these differ by more than a part in 2^36; what is closer is the same to within rounding,
/// and mostly the same value.
std::uint64_t rounded_angle(double area, double e, double f, double g) {
    const double longest = std::max(std::max(e, f), g);
    const double middle = std::max(std::min(e, f), std::min(std::max(e, f), g));
    const double measure = area * area / (longest * middle);
    constexpr unsigned kDropped = 16;  // of 52 bits; positive doubles are in order of their bits
    return (std::bit_cast<std::uint64_t>(measure) + (1U << (kDropped - 1))) >> kDropped;
}

/// Smallest angles of two triangles, the smaller first, for lexicographic comparison.
std::pair<std::uint64_t, std::uint64_t> in_order(std::uint64_t one, std::uint64_t other) {
    return {std::min(one, other), std::max(one, other)};
}

}  // namespace

void Improver::improve(const std::vector<VertexId>& vertices) {
    unasked_ = 8 * vertices.size();
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!is_named_again(vertices, i)) add_star(vertices[i]);
    seen_ = tin_.vertex_count();
    swap_pending([this](Side diagonal, Side across) {
        for (const Side outer :
             {diagonal.next(), diagonal.previous(), across.next(), across.previous()})
            if (may_swap(outer)) pending_.push_back(outer);
    });
}

std::uint64_t Improver::improve_across(std::span<const Side> outer, bool is_known) {
    const std::uint64_t before = edges_swapped_;
    pending_.insert(pending_.end(), outer.begin(), outer.end());
    seen_ = tin_.vertex_count();
    unasked_ = 8;
    swap_pending([this, is_known](Side diagonal, Side across) {
        pending_.push_back(diagonal.previous());
        pending_.push_back(across.next());
        if (is_known)
            unasked_ = 8;
        else
            pending_.insert(pending_.end(), {diagonal.next(), across.previous()});
    });
    return edges_swapped_ - before;
}

/// Swaps what waits where that is better, until nothing waits: add(diagonal, its twin) lets edges
/// around a new diagonal wait.
template <typename Add>
void Improver::swap_pending(const Add& add) {
    while (!pending_.empty()) {
        // A side that an earlier swap moved names another edge of the same two triangles, all of
        // whose edges that swap added anew: looking at it costs time, never a miss.
        const Side s = pending_.back();
        pending_.pop_back();
        if (!may_swap(s) || !should_swap(s)) continue;
        const Side diagonal = surgery_.swap_edge(s);
        ++edges_swapped_;
        add(diagonal, tin_.twin(diagonal));
    }
}

bool Improver::improve(Side s) {
    unasked_ = 1;
    if (!may_swap(s) || !should_swap(s)) return false;
    surgery_.swap_edge(s);
    ++edges_swapped_;
    return true;
}

/// Whether the vertex is one that edges of a corridor share, and comes again with the next of them:
/// what waits last is looked at first, so that once is enough, and a hub of thousands of edges is
/// not walked for each of them.
bool Improver::is_named_again(const std::vector<VertexId>& vertices, std::size_t i) {
    return (i + 1 < vertices.size() && vertices[i + 1] == vertices[i]) ||
           (i + 2 < vertices.size() && vertices[i + 2] == vertices[i]);
}

/// Adds the edges at the vertex, and those across from it in its triangles.
void Improver::add_star(VertexId v) {
    const std::uint32_t newest = std::max(v.value, static_cast<std::uint32_t>(seen_ - 1));
    for_each_side_at(tin_, v, [this, newest](Side s) { add_at(s, newest); });
}

/// Adds the side and the next one, where they may be swapped, unless one of the edge's four corners
/// is newer: then that corner's star adds it, so that no edge is looked at twice.
inline void Improver::add_at(Side side, std::uint32_t newest) {
    const auto& [v0, v1, v2] = tin_.triangle(side.triangle()).vertices;
    if (std::max({v0, v1, v2}).value > newest) return;
    for (const Side s : {side, side.next()})
        if (may_swap(s) && tin_.apex(tin_.twin(s)).value <= newest) pending_.push_back(s);
}

inline bool Improver::may_swap(Side s) const {
    return tin_.is_free(s);
}

//        c            T = (a, b, c) and U = (b, a, d), in one facet;
//       / \           the edge a -> b fails Delaunay's condition in the facet's plane when the
//     a --- b         angles at c and d sum to more than 180 degrees: when the sine of the sum is
//       \ /           negative. Areas in plan stand for the sines, for all triangles of a facet
//        d            are foreshortened alike.
bool Improver::should_swap(Side s) {
    const Tin::Triangle& beside = tin_.triangle(s.triangle());
    const Side across = beside.twins[s.index()];
    const Quad quad{beside.vertices[s.index()], beside.vertices[Side::next_of(s.index())],
                    beside.vertices[Side::previous_of(s.index())], tin_.apex(across)};
    const Tin::Vertex& a = tin_.vertex(quad.a);
    const Tin::Vertex& b = tin_.vertex(quad.b);
    const Tin::Vertex& c = tin_.vertex(quad.c);
    const Tin::Vertex& d = tin_.vertex(quad.d);
    // At c and at d the steps are the same: legs from there to a and b; the cosine times their
    // lengths; the terms that make it up; twice the area.
    const Pair x{c.x, d.x}, y{c.y, d.y}, z{c.z, d.z};
    const Pair ax = a.x - x, ay = a.y - y, az = a.z - z;
    const Pair bx = b.x - x, by = b.y - y, bz = b.z - z;
    const Pair east = ax * bx, north = ay * by, up = az * bz;
    const Pair cosine = east + north + up;
    const Pair terms = magnitudes(east) + magnitudes(north) + magnitudes(up);
    const Pair left = ax * by, right = ay * bx;
    const Pair area = left - right;
    const Pair doubt =
        detail::kAreaDoubt * (magnitudes(left) + magnitudes(right)) - magnitudes(area);
    double above = area[0], below = -area[1];
    if (!(doubt[0] < 0.0)) above = doubled_area(a.plan(), b.plan(), c.plan());
    if (!(doubt[1] < 0.0)) below = doubled_area(b.plan(), a.plan(), d.plan());
    const double sine = cosine[0] * below + cosine[1] * above;
    const double size = terms[0] * below + terms[1] * above;
    // Areas are right to 2^-36. What is nearer to zero than that may be a circle: ask the angles.
    if (sine > 0x1p-35 * size) return false;
    if (sine > -0x1p-16 * size || unasked_ == 0) return is_better_swapped(quad);
    --unasked_;
    return is_left(a.plan(), d.plan(), c.plan()) && is_left(d.plan(), b.plan(), c.plan());
}

/// Whether the smallest angles of the two triangles, in order, get larger by the swap. In exact
/// arithmetic those of a pair that fails Delaunay's condition do.
bool Improver::is_better_swapped(const Quad& quad) const {
    const auto& [a, b, c, d] = quad;
    const double beside_a = area_by_lowest_slot(tin_, a, d, c);
    const double beside_b = area_by_lowest_slot(tin_, d, b, c);
    if (!(beside_a > 0.0 && beside_b > 0.0)) return false;  // exact: the signs of areas are
    const auto squared = [this](VertexId p, VertexId q) {
        return Leg(tin_.vertex(p), tin_.vertex(q)).squared();
    };
    const double ab = squared(a, b), cd = squared(c, d);
    const double ac = squared(a, c), bc = squared(b, c), ad = squared(a, d), bd = squared(b, d);
    const auto now = in_order(rounded_angle(area_by_lowest_slot(tin_, a, b, c), ab, bc, ac),
                              rounded_angle(area_by_lowest_slot(tin_, b, a, d), ab, ad, bd));
    const auto then = in_order(rounded_angle(beside_a, ad, cd, ac),  //
                               rounded_angle(beside_b, bd, bc, cd));
    return then > now;
}

}  // namespace tinsmith::core
