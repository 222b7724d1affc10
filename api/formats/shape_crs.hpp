// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"
#include "core/integrate/shape.hpp"

namespace tinsmith::api {

/// The system that a request says its positions are in, and where it says so.
struct CrsClaim {
    std::string crs;       ///< normalised; empty: none, the positions are the terrain's
    std::string pointer;   ///< into the body; empty: a query or command line
    bool heights = false;  ///< the positions bring elevations that will be used
};

/// Positions of the claimed system, in place, as those of the terrain's. Nothing is done where the
/// two are one. Positions alone are brought over: what was straight between two of them in the one
/// system is straight in the other, as with ogr2ogr. Elevations stay the numbers that they are, in
/// the terrain's unit; a claim of a system that says what heights mean is refused with them.
///
/// Returns what is wrong, at most `most` faults, each with the position in the request's own
/// numbers: after any, the shapes are of no use.
/// Requires: `requested` is what `shapes` were made of, one for one.
Faults bring_into(const std::string& terrain_crs, const CrsClaim& claim,
                  std::span<core::Shape> shapes, std::span<const RequestedShape> requested,
                  std::size_t most);

/// The same for bare positions; `pointer` and an index is where they stand.
Faults bring_into(const std::string& terrain_crs, const CrsClaim& claim,
                  std::span<core::Point2> positions, const std::string& pointer, std::size_t most);

}  // namespace tinsmith::api
