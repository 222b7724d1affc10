// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/edit/overlay.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/regions/region.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// A mesh into which a polygon was cut, and what is inside: each triangle wholly in or out.
struct Cutout {
    Tin tin;
    Region region;            ///< empty where the polygon does not meet the mesh
    double shape_area = 0.0;  ///< plan area inside the polygon, on the mesh or not
};

struct CutoutLimits {
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    std::function<bool()> cancelled = {};
    std::function<void(double)> progress = {};  ///< told now and then what share is done
};

/// Cuts the shape's closed paths into the mesh, which the caller gives away, and finds the inside.
/// No edge is swapped. The surface stays where it was to within rounding (see `integrate`); where
/// the polygon's border is rounded to doubles the area is off by at most that times its length.
/// Errors: coordinates out of range; budgets; cancelled.
/// Cost: that of integrating the shape twice, and of its region.
Result<Cutout> cut_out(Tin tin, const Shape& shape, Winding winding,
                       const CutoutLimits& limits = {});

/// Plan area inside the shape's closed paths, by the same rules and with the same errors. Cost:
/// that of integrating it into two triangles around it.
Result<double> area_inside(const Shape& shape, Winding winding, const CutoutLimits& limits = {});

/// The inside of the shape's closed paths, by the same rules and at the same cost, as triangles
/// that fill it and share whole edges alone; none where it has no inside.
Result<std::vector<Triangle2>> triangles_inside(const Shape& shape, Winding winding,
                                                const CutoutLimits& limits = {});

}  // namespace tinsmith::core
