// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/angle_counts.hpp"

#include <algorithm>

#include "core/integrate/replaced.hpp"
#include "core/mesh/surface.hpp"

namespace tinsmith::core {

namespace {

using Corners = std::array<Point3, 3>;

void count(const Corners& corners, AngleSteps& steps) {
    const double angle = angle_degrees(smallest_angle_measure(corners[0], corners[1], corners[2]));
    const double step = angle / kAngleStep + 1e-9;
    ++steps[std::min(static_cast<std::size_t>(step), steps.size() - 1)];
}

Corners corners_now(const Tin& tin, const Tin::Triangle& t) {
    return {tin.vertex(t.vertices[0]).point(), tin.vertex(t.vertices[1]).point(),
            tin.vertex(t.vertices[2]).point()};
}

}  // namespace

AngleCounts count_angles(const Tin& tin, std::span<const UndoRecord> records) {
    AngleCounts counts;
    if (records.empty()) return counts;
    const Replaced replaced(tin, records);
    for (const auto& [id, old] : replaced.recorded()) {
        const Tin::Triangle& now = tin.triangle(id);
        const Corners was{replaced.before(old->vertices[0]), replaced.before(old->vertices[1]),
                          replaced.before(old->vertices[2])};
        const Corners is = corners_now(tin, now);
        if (now.vertices == old->vertices && was == is) continue;  // only its links or its facet
        count(was, counts.before);
        count(is, counts.after);
    }
    for (std::size_t t = records.front().triangle_count; t < tin.triangle_count(); ++t)
        count(corners_now(tin, tin.triangle({static_cast<std::uint32_t>(t)})), counts.after);
    return counts;
}

}  // namespace tinsmith::core
