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

/// Vertices that the operation moved up or down, with the elevations they had, in order.
std::vector<std::pair<VertexId, double>> moved_vertices(const Tin& tin, const UndoRecord& record) {
    std::vector<std::pair<VertexId, double>> moved;
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
    const auto shape = [&tin](const Tin::Triangle& t) {
        return TriangleShape(tin.vertex(t.vertices[0]).point(), tin.vertex(t.vertices[1]).point(),
                             tin.vertex(t.vertices[2]).point());
    };
    // Vertices keep their slots and plan positions: the old triangle is there but for elevations.
    const auto moved = moved_vertices(tin, march);
    const auto corner_before = [&](VertexId v) {
        Point3 p = tin.vertex(v).point();
        const auto found =
            std::lower_bound(moved.begin(), moved.end(), v,
                             [](const auto& entry, VertexId id) { return entry.first < id; });
        if (found != moved.end() && found->first == v) p.z = found->second;
        return p;
    };
    const auto shape_before = [&](const Tin::Triangle& t) {
        if (moved.empty()) return shape(t);
        return TriangleShape(corner_before(t.vertices[0]), corner_before(t.vertices[1]),
                             corner_before(t.vertices[2]));
    };
    const auto add = [&](TriangleId id, const Tin::Triangle& old) {
        const Tin::Triangle& now = tin.triangle(id);
        // A neighbour's link changed only.
        if (old.vertices == now.vertices && old.facet == now.facet) return;
        const TriangleShape was = shape_before(old);
        before.add(was);
        if (was.is_steeper_than(steepest)) steepest = was.squared_slope();
        after.add(shape(now));
    };
    for (const auto& [id, old] : march.triangles)
        add(id, old);
    for (std::size_t t = march.triangle_count; t < touched.triangle_end; ++t)
        after.add(shape(tin.triangle({static_cast<std::uint32_t>(t)})));
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
    result.smallest_angle_deg = {angle_degrees(before.least()), angle_degrees(after.least()),
                                 angle_degrees(before.percentile()),
                                 angle_degrees(after.percentile())};
    return result;
}

}  // namespace tinsmith::core
