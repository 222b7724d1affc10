// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// Reads the one surface of a LandXML file (1.0 to 1.2) whose definition is a TIN. A point is
/// "northing easting elevation", so that x and y are exchanged. Faces are in the file's order
/// without those that are invisible (i="1"); points that no visible face names are left out. A
/// face of a LandXML has no upper side: each comes out counter-clockwise in plan. The linear unit
/// is taken from Units, the system from CoordinateSystem's epsgCode.
/// Breaklines that run along edges of the faces are constraints. Others, boundaries, contours and
/// the like are passed over, with a note.
///
/// A document with a DOCTYPE is refused: no entity is ever defined. Faults name the point's id or
/// the face's number, and the line.
/// Memory: a document tree, of no more elements than the limits allow.
Parsed<Terrain> read_landxml(std::string_view bytes, const ReadLimits& limits);

}  // namespace tinsmith::api
