// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/measure.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "core/mesh/surface.hpp"

namespace tinsmith::core {

namespace {

/// Smallest and first percentile of the measures, in degrees; zeros where there is none.
std::pair<double, double> summarize(std::vector<double>& measures) {
    if (measures.empty()) return {0.0, 0.0};
    const auto percentile =
        measures.begin() + static_cast<std::ptrdiff_t>((measures.size() - 1) / 100);
    std::nth_element(measures.begin(), percentile, measures.end());
    const double least = *std::min_element(measures.begin(), percentile + 1);
    return {angle_degrees(least), angle_degrees(*percentile)};
}

}  // namespace

Measurement measure_operation(const Tin& tin, const UndoRecord& record) {
    Measurement result;
    std::vector<double> measures;
    const std::size_t added = tin.triangle_count() - record.triangle_count;
    measures.reserve(record.triangles.size() + added);
    // Old slots keep their vertices, and vertices their positions, so the old triangle is there.
    const auto corners = [&tin](const Tin::Triangle& t) {
        return std::array{tin.vertex(t.vertices[0]).point(), tin.vertex(t.vertices[1]).point(),
                          tin.vertex(t.vertices[2]).point()};
    };
    for (const auto& [id, old] : record.triangles) {
        if (old.vertices == tin.triangle(id).vertices) continue;  // a neighbour's link changed only
        const auto [a, b, c] = corners(old);
        measures.push_back(smallest_angle_measure(a, b, c));
        result.steepest_slope = std::max(result.steepest_slope, steepest_slope(a, b, c));
    }
    std::tie(result.smallest_angle_deg.before, result.smallest_angle_deg.p1_before) =
        summarize(measures);
    measures.clear();
    const auto add = [&](const Tin::Triangle& t) {
        const auto [a, b, c] = corners(t);
        measures.push_back(smallest_angle_measure(a, b, c));
    };
    for (const auto& [id, old] : record.triangles)
        if (old.vertices != tin.triangle(id).vertices) add(tin.triangle(id));
    for (std::size_t t = record.triangle_count; t < tin.triangle_count(); ++t)
        add(tin.triangle({static_cast<std::uint32_t>(t)}));
    std::tie(result.smallest_angle_deg.after, result.smallest_angle_deg.p1_after) =
        summarize(measures);
    return result;
}

}  // namespace tinsmith::core
