// SPDX-License-Identifier: Apache-2.0
// The march's plain step, which is almost all of them: through an edge between two facets that is
// far from everything that rounding could confuse it with. It does what `cross_facet_edge` does
// there, with each vertex and triangle looked at once.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/integrate/march.hpp"
#include "core/mesh/surface.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/chosen.hpp"

namespace tinsmith::core {

using enum Orientation;

/// An edge that the way is about to pass, and what is around it. References hold until the split.
//
//             b (left)         the march stands on c; `exit` is a -> b in the triangle (a, b, c),
//            /|\               a strictly right of the way to the segment's end, b strictly left;
//           / | \              `across` is its twin in the triangle (b, a, d)
//       c  /  |  \  d
//          \  |  /  -> end_
//           \ | /
//            \|/
//             a (right)
struct March::Passing {
    Side exit;
    Side across;
    VertexId a_id, b_id;
    const Tin::Vertex &a, &b, &c, &d;
    AreaEstimate of_a{}, of_b{};  ///< with the input segment: a's is negative, b's positive
    double longest = 0.0;         ///< no more than the edge's length
    double manhattan = 0.0;       ///< no less
};

namespace {

bool is_below(const Tin::Vertex& p, const Tin::Vertex& q) {
    return p.x != q.x ? p.x < q.x : p.y < q.y;
}

/// The marks of the triangle's sides that are inside a facet.
std::uint32_t sides_inside(const Tin::Triangle& t) {
    return t.marks & (7U << Surgery::kInsideShift);
}

}  // namespace

/// Asks for the triangle across the side, which the way may go through next.
[[gnu::always_inline]] inline void March::fetch(Side side) const {
    if (const Side twin = tin_.twin(side); twin.valid())
        __builtin_prefetch(&tin_.triangle(twin.triangle()));
}

/// Asks for the vertex that the triangle across the side has opposite.
[[gnu::always_inline]] inline void March::fetch_apex(Side side) const {
    if (const Side twin = tin_.twin(side); twin.valid())
        __builtin_prefetch(&tin_.vertex(tin_.apex(twin)));
}

/// Asks, a few points ahead, for the triangles that the path will come to, and for their corners.
void March::fetch_path() const {
    const std::vector<Point2>& points = path_->points;
    constexpr std::size_t kHint = 16, kTriangle = 7, kCorners = 3;
    if (to_ + kHint >= points.size()) return;
    __builtin_prefetch(tin_.hint_place(points[to_ + kHint]));
    __builtin_prefetch(&tin_.triangle(tin_.hint(points[to_ + kTriangle])));
    for (const VertexId v : tin_.triangle(tin_.hint(points[to_ + kCorners])).vertices)
        __builtin_prefetch(&tin_.vertex(v));
}

/// Passes plain edges from `exit` on, whose triangle has the vertex where the march stands for its
/// apex. Afterwards `exit` is the edge that is not plain, with the march standing across from it;
/// or invalid, and where the march stands the way on has to be looked for. False: stopped, see
/// `error`.
bool March::stride(Side& exit) {
    if (options_.snap > 0.0 || !path_->elevations.empty() || way_.settles_first) return true;
    while (exit.valid()) {
        const Tin::Triangle& behind = tin_.triangle(exit.triangle());
        const unsigned i = exit.index();
        const Side across = behind.twins[i];
        if (((behind.marks >> i) & kNotPlain) != 0 || !across.valid()) return true;
        fetch(across.next());
        fetch(across.previous());
        const VertexId a = behind.vertices[i], b = behind.vertices[Side::next_of(i)];
        const Tin::Vertex& from = tin_.vertex(a);
        const Tin::Vertex& to = tin_.vertex(b);
        const double dx = std::fabs(to.x - from.x), dy = std::fabs(to.y - from.y);
        const Passing here{exit,
                           across,
                           a,
                           b,
                           from,
                           to,
                           tin_.vertex(at_),
                           tin_.vertex(tin_.apex(across)),
                           estimate_doubled_area(start_, end_, from.plan()),
                           estimate_doubled_area(start_, end_, to.plan()),
                           std::max(dx, dy),
                           dx + dy};
        Point2 p;
        if (!is_plain(here) || !find_plain_split(here, p) || !is_plainly_split(here, p))
            return true;
        if (!within_budget()) return false;
        exit = pass(here, p);
    }
    return true;
}

/// Whether neither end of the edge is near the input segment, nor the edge near where the march
/// stands.
[[gnu::always_inline]] inline bool March::is_plain(const Passing& here) const {
    const double reach = reach_of_rounding_ * length_;
    if (!(here.of_a.value < -(reach + here.of_a.error) &&
          here.of_b.value > reach + here.of_b.error))
        return false;
    const AreaEstimate apex = estimate_doubled_area(here.a.plan(), here.b.plan(), here.c.plan());
    return apex.value > reach_of_rounding_ * here.manhattan + apex.error;
}

/// The segment's end, where that is plainly on the edge; where it is plainly beyond, the point in
/// which the input segment crosses the edge, as `crossing_of` has it. False: neither is plain.
[[gnu::always_inline]] inline bool March::find_plain_split(const Passing& here, Point2& p) const {
    const AreaEstimate end = estimate_doubled_area(here.a.plan(), here.b.plan(), end_);
    if (!(end.value < -(reach_of_rounding_ * here.manhattan + end.error))) {
        // Both ends of the edge are farther than that from the segment: between them.
        p = end_;
        return std::fabs(end.value) + end.error < reach_of_rounding_ * 0.499 * here.longest;
    }
    const double to_a = -here.of_a.value;
    const double to_b = here.of_b.value;
    if (!((here.of_a.error + here.of_b.error) * here.longest <=
          reach_of_rounding_ / 16.0 * (to_a + to_b)))
        return false;
    bool is_turned = to_b < to_a;
    if (to_a == to_b) is_turned = is_below(here.b, here.a);
    const Tin::Vertex& a = *chosen(is_turned, &here.b, &here.a);  // the nearer end
    const Tin::Vertex& b = *chosen(is_turned, &here.a, &here.b);
    const double share = std::min(to_a, to_b) / (to_a + to_b);
    p = {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
    p = {std::clamp(p.x, std::min(a.x, b.x), std::max(a.x, b.x)),
         std::clamp(p.y, std::min(a.y, b.y), std::max(a.y, b.y))};
    const double at = along(p);
    return at > along(here.c.plan()) && at <= along(end_);
}

/// Whether the split leaves all triangles strictly positive and bends the edge no more than the
/// rounding of one position.
[[gnu::always_inline]] inline bool March::is_plainly_split(const Passing& here, Point2 p) const {
    const Point2 a = here.a.plan(), b = here.b.plan(), c = here.c.plan(), d = here.d.plan();
    if (!is_left(a, p, c) || !is_left(p, b, c) || !is_left(b, p, d) || !is_left(p, a, d))
        return false;
    if (drift_.bend_of(here.a_id) > 0.0 || drift_.bend_of(here.b_id) > 0.0) return false;
    const AreaEstimate bent = estimate_doubled_area(a, b, p);
    return std::fabs(bent.value) + bent.error <= drift_.usual() * here.longest;
}

/// Splits the edge at p, goes there, and says by which edge the way goes on; invalid where that has
/// to be looked for.
[[gnu::always_inline]] inline Side March::pass(const Passing& here, Point2 p) {
    const Point2 a = here.a.plan(), b = here.b.plan(), d = here.d.plan();
    const bool is_end = p == end_;
    const Point2 target = is_end ? ahead_ : end_;
    // Left or right of the apex across is a coin's toss: what follows from it is chosen, not
    // branched for.
    const AreaEstimate apex = estimate_doubled_area(p, target, d);
    Orientation turn = apex.value > 0.0 ? CounterClockwise : Clockwise;
    if (!(std::fabs(apex.value) > apex.error)) turn = orientation(p, target, d);
    const bool past_a = turn != Clockwise;
    const AreaEstimate corner = estimate_doubled_area(p, target, *chosen(past_a, &a, &b));
    const double beside = chosen(past_a, -corner.value, corner.value);
    bool goes_on = beside > corner.error;
    if (!(std::fabs(beside) > corner.error))
        goes_on = past_a ? orientation(p, target, a) == Clockwise
                         : orientation(p, target, b) == CounterClockwise;
    goes_on = goes_on && turn != Collinear;
    fetch_apex({here.across.triangle(), chosen(past_a, Side::next_of(here.across.index()),
                                               Side::previous_of(here.across.index()))});
    const Seam seam = seam_of(here);
    if (open_ == at_ && !seam.covers_open) flush_open();
    const std::uint32_t below =
        std::max(drift_.nesting_of(here.a_id), drift_.nesting_of(here.b_id));
    const double z = elevation_between(here.a, here.b, p);
    const Point3 point{p.x, p.y, z};
    const VertexId v = surgery_.split_and_pass(here.exit, point, past_a, options_.lock);
    const TriangleId entered{static_cast<std::uint32_t>(tin_.triangle_count() - 1)};
    drift_.nest(v, below);
    if (!is_end) {
        ++tally_.crossings;
        measure(v);
    }
    tally_.chains.back().vertices.push_back(v);
    at_ = v;
    way_on_ = {entered, past_a ? 0U : 1U};  // from p to a or to d
    const Side beyond = way_on_.next();
    const bool stays = close(seam, {here.exit.previous(),
                                    {{entered.value - 1}, 1},
                                    chosen(past_a, here.across.previous(), here.across.next()),
                                    beyond});
    if (!stays) way_on_ = {};
    const Side exit = goes_on && stays ? beyond : Side{};
    if (!is_end) return exit;
    exit_ahead_ = exit;
    return {};
}

/// What the split leaves to improve, which is known while the triangles are at hand: where facets
/// were whole before the way cut through them, one edge of each, that is looked at as soon as the
/// way is out of the facet.
[[gnu::always_inline]] inline March::Seam March::seam_of(const Passing& here) const {
    Seam seam;
    if (improver_ == nullptr) return seam;
    const Side next = here.exit.next(), previous = here.exit.previous();
    // One question of both, for the answers cannot be foreseen.
    const unsigned next_is_free = tin_.is_free(next), previous_is_free = tin_.is_free(previous);
    const TriangleId behind = here.exit.triangle();
    seam.covers_open = (unsigned{behind == open_entered_} | unsigned{behind == open_other_}) != 0;
    seam.is_whole = sides_inside(tin_.triangle(here.across.triangle())) == 0;
    seam.is_simple = seam.is_whole && (next_is_free & previous_is_free) == 0;
    if ((unsigned{seam.is_simple} & (next_is_free | previous_is_free)) == 0) return seam;
    const Side free(behind, chosen(next_is_free != 0, next.index(), previous.index()));
    const std::uint32_t beyond = sides_inside(tin_.triangle(tin_.twin(free).triangle()));
    seam.is_simple = (beyond & (beyond - 1)) == 0;
    seam.free = free;
    seam.is_next = next_is_free != 0;
    return seam;
}

/// Improves what the split left, or leaves it to the improver. False: swaps may have changed the
/// triangle that the way enters.
[[gnu::always_inline]] inline bool March::close(const Seam& seam, const Outer& outer) {
    open_ = {};
    if (!seam.is_simple) return close_all(seam, outer);
    open_ = at_;
    open_entered_ = outer.entered.triangle();
    open_other_ = outer.other.triangle();
    if (!seam.free.valid()) return true;
    // The split moved the side after the edge to the new triangle behind it.
    Side free;
    free.code = chosen(seam.is_next, outer.behind_too.code, seam.free.code);
    improver_->improve(free);
    return true;
}

/// Where facets had more triangles than one.
bool March::close_all(const Seam& seam, const Outer& outer) {
    if (!knows_facets_ || !changed_.empty()) {
        changed_.push_back(at_);
        return true;
    }
    const std::array sides{outer.behind, outer.behind_too, outer.other, outer.entered};
    improver_->improve_across(sides, true);
    return seam.is_whole;
}

/// Leaves the vertex to the improver after all: the way does not go on from it by a plain step.
void March::flush_open() {
    if (open_.valid()) changed_.push_back(open_);
    open_ = {};
}

}  // namespace tinsmith::core
