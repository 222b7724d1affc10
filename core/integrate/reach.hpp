// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/mesh/tin.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

/// How far rounding may put a vertex off its place: 4 ulp of the mesh's largest coordinate.
inline double reach_of_rounding(const Tin& tin) {
    const Bounds& box = tin.bounds();
    return 4.0 * ulp(std::max({std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.max.x),
                               std::fabs(box.max.y)}));
}

/// Of the reach: what rounding does to a position that was computed on an edge. Not added up.
inline constexpr double kUsualDrift = 0.1875;

}  // namespace tinsmith::core
