// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/measure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/mesh/surface.hpp"

namespace tinsmith::core {

namespace {

/// The least of many values and their first percentile, in one pass: keeps the values that may
/// still be among the lowest hundredth, and few more.
class Lowest {
  public:
    /// `most`: no more values than that will come.
    explicit Lowest(std::size_t most) : keep_(most / 100 + 1) {
        values_.reserve(std::min(most, 2 * keep_));
    }

    /// What is not below it is of no interest any more.
    double bound() const { return bound_; }

    /// Counts a triangle whose value is not below the bound.
    void pass_over() { ++count_; }

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
    double percentile() {
        if (values_.empty()) return 0.0;
        const auto place = values_.begin() + static_cast<std::ptrdiff_t>((count_ - 1) / 100);
        std::nth_element(values_.begin(), place, values_.end());
        return *place;
    }

  private:
    void drop() {
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

/// Two doubles in one register: east and north take the same steps.
typedef double Pair __attribute__((vector_size(16)));  // NOLINT(modernize-use-using): GCC 12
inline Pair plan_of(const Tin::Vertex& v) {
    return Pair{v.x, v.y};
}
inline double sum_of(Pair p) {
    return p[0] + p[1];
}

/// How far off a glance may be.
constexpr double kMargin = 1.01;
/// Rounding is below 2^-50 of the squared edges: below a thousandth of the area where the squared
/// sine of the smallest angle is as large as this.
constexpr double kLeast = 0x1p-78;

/// What a triangle is like, at a glance: right to a hundredth, which is enough to pass over most.
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
        // Half the sum of the three squared edges: no less than the mean of the two longest.
        const double half = sum_of(u * u + v * v - u * v) + (uz * uz + vz * vz - uz * vz);
        longest_squared_ = half * half;
    }

    /// Never true where `TriangleShape::has_angle_below` is.
    bool is_blunter_than(double bound) const {
        return upright_squared_ > kMargin * std::max(bound, kLeast) * longest_squared_;
    }
    /// Never true where `TriangleShape::is_steeper_than` is. Requires: not a needle, see above.
    bool is_flatter_than(double squared_slope) const {
        return kMargin * level_squared_ <= squared_slope * upright_squared_;
    }

  private:
    double level_squared_;    ///< of the normal that is as long as twice the area
    double upright_squared_;  ///< of its vertical part
    double longest_squared_;  ///< no less than the product of the two longest edges, squared
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
        const double half = sum_of(u * u + v * v - u * v);
        longest_squared_ = half * half;
    }

    bool is_blunter_than(double bound) const {
        return area_squared_ > kMargin * std::max(bound, kLeast) * longest_squared_;
    }

  private:
    double area_squared_;
    double longest_squared_;
};

/// Whether only a neighbour's link changed. One comparison, for nobody can guess each of four.
bool is_same_piece(const Tin::Triangle& old, const Tin::Triangle& now) {
    return ((old.vertices[0].value ^ now.vertices[0].value) |
            (old.vertices[1].value ^ now.vertices[1].value) |
            (old.vertices[2].value ^ now.vertices[2].value) |
            (old.facet.value ^ now.facet.value)) == 0;
}

/// Asks for what comes a few triangles later: the record names old triangles in the order in which
/// they were met, and they may have left the cache since.
void fetch_ahead(const Tin& tin, const UndoRecord& record, std::size_t i) {
    constexpr std::size_t kTriangles = 16, kVertices = 8;
    if (i + kTriangles >= record.triangles.size()) return;
    __builtin_prefetch(&tin.triangle(record.triangles[i + kTriangles].first));
    for (const VertexId v : record.triangles[i + kVertices].second.vertices)
        __builtin_prefetch(&tin.vertex(v));
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

}  // namespace

Measurement measure_operation(const Tin& tin, const Touched& touched) {
    const UndoRecord& march = touched.march;
    const std::size_t most = march.triangles.size() + touched.triangle_end - march.triangle_count +
                             (touched.across != nullptr ? touched.across->triangles.size() : 0);
    Lowest before(most);
    Lowest after(most);
    double steepest = 0.0;  // squared
    VertexId newest{0};     // corner of an old triangle
    // Vertices keep their slots and plan positions: the old triangle is there but for elevations.
    const auto moved = moved_vertices(tin, march);
    const auto corner_before = [&](VertexId v) {
        Tin::Vertex corner = tin.vertex(v);
        const auto found =
            std::lower_bound(moved.begin(), moved.end(), v,
                             [](const auto& entry, VertexId id) { return entry.first < id; });
        if (found != moved.end() && found->first == v) corner.z = found->second;
        return corner;
    };
    const auto add_before = [&](const Tin::Vertex& a, const Tin::Vertex& b, const Tin::Vertex& c) {
        const Glance glance(a, b, c);
        if (glance.is_blunter_than(before.bound()) && glance.is_flatter_than(steepest))
            return before.pass_over();
        const TriangleShape was(a.point(), b.point(), c.point());
        before.add(was);
        if (was.is_steeper_than(steepest)) steepest = was.squared_slope();
    };
    const auto add_after = [&](const Tin::Triangle& t) {
        const Tin::Vertex& a = tin.vertex(t.vertices[0]);
        const Tin::Vertex& b = tin.vertex(t.vertices[1]);
        const Tin::Vertex& c = tin.vertex(t.vertices[2]);
        if (Glance(a, b, c).is_blunter_than(after.bound())) return after.pass_over();
        after.add({a.point(), b.point(), c.point()});
    };
    const auto add = [&](TriangleId id, const Tin::Triangle& old) {
        const Tin::Triangle& now = tin.triangle(id);
        if (is_same_piece(old, now)) return;
        const auto& [a, b, c] = old.vertices;
        newest = std::max({newest, a, b, c});
        if (moved.empty())
            add_before(tin.vertex(a), tin.vertex(b), tin.vertex(c));
        else
            add_before(corner_before(a), corner_before(b), corner_before(c));
        add_after(now);
    };
    for (std::size_t i = 0; i < march.triangles.size(); ++i) {
        fetch_ahead(tin, march, i);
        add(march.triangles[i].first, march.triangles[i].second);
    }
    // New triangles lie in the old facets, where nothing was moved up or down: none is steeper.
    const double stretch = 1.01 * (1.0 + steepest);
    const bool is_flat_enough = moved.empty() && touched.across == nullptr;
    for (std::size_t t = march.triangle_count; t < touched.triangle_end; ++t) {
        const Tin::Triangle& triangle = tin.triangle({static_cast<std::uint32_t>(t)});
        const auto& [a, b, c] = triangle.vertices;
        if (is_flat_enough && PlanGlance(tin.vertex(a), tin.vertex(b), tin.vertex(c))
                                  .is_blunter_than(stretch * after.bound()))
            after.pass_over();
        else
            add_after(triangle);
    }
    if (touched.across != nullptr) {
        std::vector<TriangleId> known;
        for (const auto& [id, old] : march.triangles)
            known.push_back(id);
        std::sort(known.begin(), known.end());
        for (const auto& [id, old] : touched.across->triangles)
            if (id.index() < march.triangle_count &&
                !std::binary_search(known.begin(), known.end(), id))
                add(id, old);
    }

    Measurement result;
    result.steepest_slope = std::sqrt(steepest);
    result.met_divided_facets = newest.index() >= tin.built_vertex_count();
    result.smallest_angle_deg = {angle_degrees(before.least()), angle_degrees(after.least()),
                                 angle_degrees(before.percentile()),
                                 angle_degrees(after.percentile())};
    return result;
}

}  // namespace tinsmith::core
