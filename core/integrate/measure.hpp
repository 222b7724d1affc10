// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/integrate/report.hpp"
#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// What an operation did to the triangles it touched.
struct Measurement {
    AngleSummary smallest_angle_deg;
    double steepest_slope = 0.0;  ///< of the touched triangles as they were
    /// Whether any of them shared its facet with others, made by an operation before.
    bool met_divided_facets = false;
};

/// The records of one shape: of its march, and of swaps across facets that followed it, if any.
struct Touched {
    const UndoRecord& march;
    std::size_t triangle_end = 0;  ///< how many triangles there were after the march
    const UndoRecord* across = nullptr;
};

/// Cost: linear in the triangles touched.
Measurement measure_operation(const Tin& tin, const Touched& touched);

}  // namespace tinsmith::core
