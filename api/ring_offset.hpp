// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <variant>

#include "core/edit/overlay.hpp"
#include "core/integrate/shape.hpp"

namespace tinsmith::api {

/// The border of an area, and what lies at a distance from it. Closed paths, even-odd; all lengths
/// in the unit of the coordinates.
struct RingOffset {
    core::Shape ring;
    core::Shape border;
};

/// Why there is no such ring.
struct NoRing {
    enum class Reason {
        Empty,     ///< the area has no inside
        TooThin,   ///< a part of the area would vanish: `limit` is what it bears, somewhat less
        TooSmall,  ///< coordinates of this size do not tell both lines apart: `limit` is the least
        Stopped,   ///< it was told to stop
        Failed,    ///< the library gave up, for want of memory or by a defect
    };
    Reason reason = Reason::Failed;
    double limit = 0.0;
};

/// The ring at the distance inside the border, corners mitred up to twice the distance and cut
/// beyond; a part of the area that is narrower than twice the distance in places falls into several
/// rings, and one that is so everywhere is a fault.
/// Requires here and below: triangles fill the area and share whole edges alone
/// (`core::triangles_inside`); the distance is above 0.
/// `stop`, which may be empty, is asked now and then, on the caller's thread; true ends the work.
/// Cost: of the library, and for lines that lie close together it grows with the square of their
/// points: 10,000 may take a minute. So give `stop`.
/// Not promised: the same bytes by another version of the library. So rings are kept with what was
/// made of them.
std::variant<RingOffset, NoRing> ring_inside(std::span<const core::Triangle2> area, double distance,
                                             const std::function<bool()>& stop = {});

/// The ring at the distance outside the border, corners rounded by arcs of eight segments to a
/// quarter. Holes that are narrower than twice the distance close.
std::variant<RingOffset, NoRing> ring_outside(std::span<const core::Triangle2> area,
                                              double distance,
                                              const std::function<bool()>& stop = {});

}  // namespace tinsmith::api
