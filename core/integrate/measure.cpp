// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/measure.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/surface.hpp"
#include "core/types/pair.hpp"

namespace tinsmith::core {

namespace {

/// The least of many values and their first percentile, in one pass: keeps the values that may
/// still be among the lowest hundredth, and few more.
/// What is rare stays out of line, here and below: an edit of some hundred triangles spends a
/// quarter of its time on code that comes into the cache.
class Lowest {
  public:
    /// `most`: no more values than that will come.
    explicit Lowest(std::size_t most) : keep_(most / 100 + 1) {
        values_.reserve(std::min(most, 2 * keep_));
    }

    /// What is not below it is of no interest any more.
    double bound() const { return bound_; }

    /// Counts triangles whose values are not below the bound.
    void pass_over(std::size_t triangles) { count_ += triangles; }

    void add(const TriangleShape& shape) {
        ++count_;
        if (!shape.has_angle_below(bound_)) return;  // spares most triangles a division
        values_.push_back(shape.smallest_angle_measure());
        if (values_.size() == 2 * keep_) drop();
    }

    /// The smallest, zero where there is none.
    double least() const {
        return values_.empty() ? 0.0 : *std::min_element(values_.begin(), values_.end());
    }

    /// The value that has a hundredth of the others below it, zero where there is none.
    [[gnu::noinline]] double percentile() {
        if (values_.empty()) return 0.0;
        const auto place = values_.begin() + static_cast<std::ptrdiff_t>((count_ - 1) / 100);
        std::nth_element(values_.begin(), place, values_.end());
        return *place;
    }

  private:
    [[gnu::noinline]] void drop() {
        const auto last = values_.begin() + static_cast<std::ptrdiff_t>(keep_ - 1);
        std::nth_element(values_.begin(), last, values_.end());
        bound_ = *last;
        values_.resize(keep_);
    }

    std::size_t keep_;
    std::size_t count_ = 0;
    double bound_ = 1.0;  ///< as many values as are kept are no larger
    std::vector<double> values_;
};

/// East and north take the same steps.
inline Pair plan_of(const Tin::Vertex& v) {
    return Pair{v.x, v.y};
}

/// How far off a glance may be, as a factor. Where the terrain is a grid or a plane, many triangles
/// are as blunt, or as steep, as what they are held against: all of these are looked at.
constexpr double kMargin = 1.0 + 0x1p-18;
/// Rounding moves areas by less than 2^-49 of the product of two edges: squares of areas by less
/// than a part in 2^20 where the squared sine of the smallest angle is as large as this.
constexpr double kLeast = 0x1p-56;
/// Squares of areas that are smaller than this may have lost digits.
constexpr double kSmallest = 0x1p-960;

/// What a triangle is like, at a glance: right to the margin, which is enough to pass over most.
class Glance {
  public:
    Glance(const Tin::Vertex& a, const Tin::Vertex& b, const Tin::Vertex& c) {
        const Pair origin = plan_of(a);
        const Pair u = plan_of(b) - origin, v = plan_of(c) - origin;
        const double uz = b.z - a.z, vz = c.z - a.z;
        const Pair level = u * vz - v * uz;  // turned by a right angle
        const Pair cross = u * Pair{v[1], v[0]};
        const double upright = cross[0] - cross[1];
        level_squared_ = sum_of(level * level);
        upright_squared_ = upright * upright;
        const double uu = sum_of(u * u) + uz * uz, vv = sum_of(v * v) + vz * vz;
        const double ww = (uu + vv) - 2.0 * (sum_of(u * v) + uz * vz);
        // Of two and the larger of them the third: of three products the largest.
        longest_squared_ = std::max(uu * vv, std::max(uu, vv) * ww);
    }

    /// Never true where `TriangleShape::has_angle_below` is.
    bool is_blunter_than(double bound) const {
        return level_squared_ + upright_squared_ >
               std::max(kMargin * std::max(bound, kLeast) * longest_squared_, kSmallest);
    }
    /// Never true where `TriangleShape::is_steeper_than` is. Of needles in plan it says so only of
    /// level ones.
    bool is_flatter_than(double squared_slope) const {
        const double least = std::max(kLeast * longest_squared_, kSmallest);
        return std::max(kMargin * level_squared_, squared_slope * least) <=
               squared_slope * upright_squared_;
    }

  private:
    double level_squared_;    ///< of the normal that is as long as twice the area
    double upright_squared_;  ///< of its vertical part
    double longest_squared_;  ///< product of the two longest edges, squared
};

/// The same in plan alone. On a plane of slope s all lengths are at most sqrt(1 + s^2) times what
/// they are in plan, and areas are just that: the sine of the smallest angle, squared, is no less
/// than that in plan by 1 + s^2.
class PlanGlance {
  public:
    PlanGlance(const Tin::Vertex& a, const Tin::Vertex& b, const Tin::Vertex& c) {
        const Pair origin = plan_of(a);
        const Pair u = plan_of(b) - origin, v = plan_of(c) - origin;
        const Pair cross = u * Pair{v[1], v[0]};
        const double area = cross[0] - cross[1];
        area_squared_ = area * area;
        // Half the sum of the three squared edges: no less than the mean of the two longest.
        const double half = sum_of(u * u + v * v - u * v);
        longest_squared_ = half * half;
    }

    bool is_blunter_than(double bound) const {
        return area_squared_ >
               std::max(kMargin * std::max(bound, kLeast) * longest_squared_, kSmallest);
    }

  private:
    double area_squared_;
    double longest_squared_;  ///< no less than the product of the two longest edges, squared
};

/// Whether only a neighbour's link changed. One comparison, for nobody can foresee each of four.
bool is_same_piece(const Tin::Triangle& old, const Tin::Triangle& now) {
    return ((old.vertices[0].value ^ now.vertices[0].value) |
            (old.vertices[1].value ^ now.vertices[1].value) |
            (old.vertices[2].value ^ now.vertices[2].value) |
            (old.facet.value ^ now.facet.value)) == 0;
}

/// Vertices that the operation moved up or down, with the elevations they had, in order.
std::vector<std::pair<VertexId, double>> moved_vertices(const Tin& tin, const UndoRecord& record) {
    std::vector<std::pair<VertexId, double>> moved;
    if (!record.moved_vertices) return moved;
    for (const auto& [id, old] : record.vertices)
        if (old.z != tin.vertex(id).z) moved.emplace_back(id, old.z);
    // The first record of a vertex is what it was before the operation.
    std::stable_sort(moved.begin(), moved.end(),
                     [](const auto& l, const auto& r) { return l.first < r.first; });
    return moved;
}

/// Triangles are glanced at some at a time, without a branch: what a glance costs is the way to
/// memory, and the processor asks ahead only as far as it can foresee the way. Each has a bit of a
/// mask; what a glance does not pass over is looked at afterwards. Bounds may be older than that:
/// then more is looked at than need be, never less.
using Mask = std::uint64_t;
constexpr std::size_t kBlock = 64;

std::size_t count_of(Mask mask) {
    return static_cast<std::size_t>(std::popcount(mask));
}

template <typename Visit>
void for_each_bit(Mask mask, Visit visit) {
    for (; mask != 0; mask &= mask - 1)
        visit(static_cast<std::size_t>(std::countr_zero(mask)));
}

/// What an operation's triangles are like, before it and after it.
class Survey {
  public:
    Survey(const Tin& tin, const Touched& touched)
        : tin_(tin), moved_(moved_vertices(tin, touched.march)), most_(most_of(touched)) {}

    /// A triangle as it was; as it is now, where it is another one.
    void add(std::span<const std::pair<TriangleId, Tin::Triangle>> old) {
        for (std::size_t i = 0; i < old.size(); i += kBlock)
            add_block(old.subspan(i), std::min(kBlock, old.size() - i));
    }

    /// New triangles, by slot. They lie in old facets that were added before.
    void add_new(std::size_t begin, std::size_t end, bool is_flat_enough) {
        for (std::size_t t = begin; t < end; t += kBlock)
            add_new_block(t, std::min(kBlock, end - t), is_flat_enough);
    }

    bool moved_any() const { return !moved_.empty(); }

    Measurement result() {
        Measurement result;
        result.steepest_slope = std::sqrt(steepest_);
        result.met_divided_facets = newest_ >= tin_.built_vertex_count();
        result.smallest_angle_deg = {angle_degrees(before_.least()), angle_degrees(after_.least()),
                                     angle_degrees(before_.percentile()),
                                     angle_degrees(after_.percentile())};
        return result;
    }

  private:
    static std::size_t most_of(const Touched& touched) {
        return touched.march.triangles.size() + touched.triangle_end -
               touched.march.triangle_count +
               (touched.across != nullptr ? touched.across->triangles.size() : 0);
    }

    /// Asks for what comes a few triangles later: the record names old ones in the order in which
    /// they were met, and they may have left the cache since. Inlined, for a call that only asks is
    /// optimized away.
    [[gnu::always_inline]] void fetch_ahead(
        std::span<const std::pair<TriangleId, Tin::Triangle>> old, std::size_t i) const {
        constexpr std::size_t kTriangles = 24, kVertices = 12;
        const std::size_t last = old.size() - 1;
        __builtin_prefetch(&tin_.triangle(old[std::min(i + kTriangles, last)].first));
        for (const VertexId v : old[std::min(i + kVertices, last)].second.vertices)
            __builtin_prefetch(&tin_.vertex(v));
    }

    /// The first so many.
    void add_block(std::span<const std::pair<TriangleId, Tin::Triangle>> old, std::size_t count) {
        const double bound_before = before_.bound(), bound_after = after_.bound();
        Mask changed = 0, was_plain = 0, is_plain = 0;
        for (std::size_t i = 0; i < count; ++i) {
            fetch_ahead(old, i);
            const Tin::Triangle& was = old[i].second;
            const Tin::Triangle& now = tin_.triangle(old[i].first);
            const bool is_other = !is_same_piece(was, now);
            const Glance before = glance_at(was), after = glance_at(now);
            const Mask is_blunt{before.is_blunter_than(bound_before)};
            const Mask is_flat{before.is_flatter_than(steepest_)};
            changed |= Mask{is_other} << i;
            was_plain |= (is_blunt & is_flat) << i;
            is_plain |= Mask{after.is_blunter_than(bound_after)} << i;
            const auto& [a, b, c] = was.vertices;
            newest_ = std::max(newest_, std::max({a, b, c}).value * std::uint32_t{is_other});
        }
        if (moved_any()) was_plain = 0;  // not as it was then
        before_.pass_over(count_of(changed & was_plain));
        after_.pass_over(count_of(changed & is_plain));
        for_each_bit(changed & ~was_plain, [&](std::size_t i) { look_before(old[i].second); });
        for_each_bit(changed & ~is_plain,
                     [&](std::size_t i) { look_after(tin_.triangle(old[i].first)); });
    }

    void add_new_block(std::size_t begin, std::size_t count, bool is_flat_enough) {
        const auto triangle = [&](std::size_t i) -> const Tin::Triangle& {
            return tin_.triangle({static_cast<std::uint32_t>(begin + i)});
        };
        // They lie in old facets, where nothing was moved up or down: none is steeper.
        const double bound = kMargin * (1.0 + steepest_) * after_.bound();
        Mask is_plain = 0;
        for (std::size_t i = 0; i < count && is_flat_enough; ++i) {
            const auto& [a, b, c] = triangle(i).vertices;
            const PlanGlance glance(tin_.vertex(a), tin_.vertex(b), tin_.vertex(c));
            is_plain |= Mask{glance.is_blunter_than(bound)} << i;
        }
        after_.pass_over(count_of(is_plain));
        const Mask all = count == kBlock ? ~Mask{0} : (Mask{1} << count) - 1;
        for_each_bit(all & ~is_plain, [&](std::size_t i) { look_after(triangle(i)); });
    }

    Glance glance_at(const Tin::Triangle& t) const {
        const auto& [a, b, c] = t.vertices;
        return {tin_.vertex(a), tin_.vertex(b), tin_.vertex(c)};
    }

    [[gnu::noinline]] void look_before(const Tin::Triangle& t) {
        const auto& [a, b, c] = t.vertices;
        const TriangleShape was(corner_before(a), corner_before(b), corner_before(c));
        before_.add(was);
        if (was.is_steeper_than(steepest_)) steepest_ = was.squared_slope();
    }

    [[gnu::noinline]] void look_after(const Tin::Triangle& t) {
        const auto& [a, b, c] = t.vertices;
        after_.add({tin_.vertex(a).point(), tin_.vertex(b).point(), tin_.vertex(c).point()});
    }

    /// Vertices keep their slots and plan positions: old triangles are there but for elevations.
    Point3 corner_before(VertexId v) const {
        Point3 corner = tin_.vertex(v).point();
        const auto found =
            std::lower_bound(moved_.begin(), moved_.end(), v,
                             [](const auto& entry, VertexId id) { return entry.first < id; });
        if (found != moved_.end() && found->first == v) corner.z = found->second;
        return corner;
    }

    const Tin& tin_;
    std::vector<std::pair<VertexId, double>> moved_;
    std::size_t most_;
    Lowest before_{most_};
    Lowest after_{most_};
    double steepest_ = 0.0;     ///< slope, squared
    std::uint32_t newest_ = 0;  ///< corner of an old triangle
};

}  // namespace

Measurement measure_operation(const Tin& tin, const Touched& touched) {
    const UndoRecord& march = touched.march;
    Survey survey(tin, touched);
    survey.add(march.triangles);
    survey.add_new(march.triangle_count, touched.triangle_end,
                   !survey.moved_any() && touched.across == nullptr);
    if (touched.across != nullptr) {
        std::vector<TriangleId> known;
        for (const auto& [id, old] : march.triangles)
            known.push_back(id);
        std::sort(known.begin(), known.end());
        std::vector<std::pair<TriangleId, Tin::Triangle>> others;
        for (const auto& [id, old] : touched.across->triangles)
            if (id.index() < march.triangle_count &&
                !std::binary_search(known.begin(), known.end(), id))
                others.emplace_back(id, old);
        survey.add(others);
    }
    return survey.result();
}

}  // namespace tinsmith::core
