// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "core/regions/region.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::test {

/// A shape and what integrating it reported, as a session keeps them.
struct Integrated {
    core::Shape shape;
    core::ShapeReport report;
    core::Undo undo;

    core::Outline outline() const { return {shape, report.chains, report.outside}; }
    core::Region region(const core::Tin& tin,
                        core::Winding winding = core::Winding::EvenOdd) const {
        return core::find_region(tin, core::ConstraintHistory(tin), outline(), winding);
    }
};

inline Integrated integrated(core::Tin& tin, core::Shape shape,
                             const core::IntegrateOptions& options = {}) {
    Integrated made{std::move(shape), {}, {}};
    const auto report = core::integrate(tin, {&made.shape, 1}, options, &made.undo);
    EXPECT_TRUE(report.ok()) << report.errors()[0].detail;
    if (report) made.report = report->shapes[0];
    return made;
}

inline core::Path closed(std::vector<core::Point2> points) {
    return {std::move(points), true};
}

inline core::Path box(double x0, double y0, double x1, double y1) {
    return closed({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

inline core::Path reversed(core::Path path) {
    std::reverse(path.points.begin(), path.points.end());
    return path;
}

/// A grid on the plane z = 3/4 x, where surface areas are 5/4 of those in plan.
inline core::MeshData slope(unsigned columns, unsigned rows) {
    core::MeshData mesh = grid(columns, rows, Diagonals::Alternate);
    for (core::Point3& v : mesh.vertices)
        v.z = 0.75 * v.x;
    return mesh;
}

}  // namespace tinsmith::test
