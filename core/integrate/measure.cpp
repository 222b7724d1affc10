// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/measure.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

Measurement measure_operation(const Tin& tin, const UndoRecord& record) {
    const std::size_t added = tin.triangle_count() - record.triangle_count;
    Lowest before(record.triangles.size());
    Lowest after(record.triangles.size() + added);
    double steepest = 0.0;  // squared
    // Old slots keep their vertices, and vertices their positions, so the old triangle is there.
    const auto shape = [&tin](const Tin::Triangle& t) {
        return TriangleShape(tin.vertex(t.vertices[0]).point(), tin.vertex(t.vertices[1]).point(),
                             tin.vertex(t.vertices[2]).point());
    };
    for (const auto& [id, old] : record.triangles) {
        const Tin::Triangle& now = tin.triangle(id);
        if (old.vertices == now.vertices) continue;  // a neighbour's link changed only
        const TriangleShape was = shape(old);
        before.add(was);
        if (was.is_steeper_than(steepest)) steepest = was.squared_slope();
        after.add(shape(now));
    }
    for (std::size_t t = record.triangle_count; t < tin.triangle_count(); ++t)
        after.add(shape(tin.triangle({static_cast<std::uint32_t>(t)})));

    Measurement result;
    result.steepest_slope = std::sqrt(steepest);
    result.smallest_angle_deg = {angle_degrees(before.least()), angle_degrees(after.least()),
                                 angle_degrees(before.percentile()),
                                 angle_degrees(after.percentile())};
    return result;
}

}  // namespace tinsmith::core
