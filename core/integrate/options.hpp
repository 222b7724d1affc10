// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// Which edges are swapped for better triangles once the lines are in. Constrained, locked and
/// boundary edges never are.
enum class Improve {
    None,     ///< leave what the march made
    Strict,   ///< within facets only: best triangles, surface unmoved
    Paper,    ///< across facets too, by the criterion of Stanchev & Paraskevov 2023, section 3.4
    Bounded,  ///< like Paper, but no point of the surface moves by more than `max_deviation`
};

/// What becomes of the parts of a request that lie outside the mesh.
enum class Outside {
    Skip,    ///< integrate what meets the mesh, list the rest
    Reject,  ///< refuse the request if any part is outside
};

/// Whose elevation a vertex takes where a path with elevations of its own meets a constraint that
/// was there: the ends of constrained edges and crossings with them.
enum class OnCrossing {
    New,  ///< the path's
    Old,  ///< that of the mesh before the request
};

/// What to say when `IntegrateOptions::ids` leaves no facet.
inline constexpr const char* kNoFacetLeft =
    "the mesh has used up the numbers of its facets; nothing was changed; save it and make a new "
    "session of it, where they start anew";

struct IntegrateOptions {
    Improve improve = Improve::Strict;
    double max_deviation = 0.0;  ///< for Improve::Bounded, session unit
    Outside outside = Outside::Skip;
    OnCrossing on_crossing = OnCrossing::New;
    /// A vertex or edge of the mesh within this distance of a path takes the path's place there.
    /// Zero: only what rounding forces. Session unit.
    double snap = 0.0;
    bool lock = false;  ///< the paths' edges are locked as well as constrained
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    /// What the mesh may use up before the request is refused: what ids can count. Less in tests.
    IdLimits ids = {};
    /// Asked now and then; true stops the work and leaves the mesh as it was.
    std::function<bool()> cancelled = {};
    /// Told now and then how much of the work is done, from 0 to 1. It may fall back where rounding
    /// made the request begin again.
    std::function<void(double)> progress = {};
    /// Milliseconds from any fixed start; for the report alone, never in a decision.
    std::function<double()> clock_ms = {};
    /// Where walks begin: 0 for the nearest hint, else triangle `walk_seed` modulo their number.
    /// Changes the cost, never the result.
    std::uint32_t walk_seed = 0;
};

}  // namespace tinsmith::core
