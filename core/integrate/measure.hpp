// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/integrate/report.hpp"
#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// What an operation did to the triangles it touched, from its undo record. Cost: linear in them.
struct Measurement {
    AngleSummary smallest_angle_deg;
    double steepest_slope = 0.0;  ///< of the touched triangles as they were
};

Measurement measure_operation(const Tin& tin, const UndoRecord& record);

}  // namespace tinsmith::core
