// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"
#include "core/types/point.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// What `lock_along` found and did. Lengths in plan, in the session's unit.
struct LockReport {
    std::size_t edges = 0;    ///< along the line
    std::size_t changed = 0;  ///< of these, locked now and not before, or the other way round
    double length = 0.0;      ///< of the edges
    /// Stretches of the line, longer than the reach, along which there is no edge.
    std::vector<std::vector<Point2>> without_edge;
};

/// What locking along lines may still cost. Each line takes its part of it.
struct LockBudget {
    std::uint64_t visits = UINT64_MAX;          ///< of triangles; what lies along counts more
    std::function<bool()> cancelled = nullptr;  ///< asked every few thousand visits
};

/// Locks the mesh's edges along a line, or unlocks them: all edges that are within `reach` of it
/// from end to end (at least 4 ulp of the mesh's largest coordinate) and run more along it than
/// across it. Locked edges are swapped in no mode; what crosses them may split them, and both
/// halves stay locked. Adds no vertex and moves none. Where `undo` is given it takes what
/// `take_back` needs.
/// Errors: coordinates out of range; fewer than two positions; no edge along the line at all; the
/// budget, where one is given, used up or cancelled. The mesh is then as it was.
/// Not promised: parts of the mesh narrower than the reach that only the reach touches.
/// Cost: the triangles within reach of the line, once for each of its segments. Memory: a bit for
/// each of these in pages, and some words for each edge along a segment.
Result<LockReport> lock_along(Tin& tin, const Path& line, double reach, bool locked,
                              Undo* undo = nullptr, LockBudget* budget = nullptr);

}  // namespace tinsmith::core
