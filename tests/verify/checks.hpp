// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/verify/edit.hpp"

namespace tinsmith::verify {

// Each check returns what is broken, in words; nothing when its guarantee holds. They read plain
// buffers, none of the core's structure or predicates. The later ones require the earlier ones.

/// All indices name vertices; coordinates are finite. What `Snapshot` requires.
Faults check_indices(const core::MeshData& mesh);

/// G1: triangles strictly counter-clockwise; each directed edge of one triangle at most; one fan
/// around each vertex; none unreferenced; constraints are edges, each once.
Faults check_validity(const Snapshot& mesh);

/// What changed between two meshes, by slot.
struct Change {
    std::vector<std::uint32_t> removed;  ///< old triangles whose slot has other vertices now
    std::vector<std::uint32_t> added;    ///< new triangles, in those slots and after
    std::vector<bool> was_removed;       ///< by old slot
};

/// G2 and G4, the plan: old vertices stay; the new triangles cover exactly what the removed ones
/// did, each place once, but for outline edges a-b that became chains from a to b within rounding.
/// Why that suffices: positive triangles cover each place as often as their outline winds round it,
/// and both outlines are compared edge by edge. Fills `change`.
Faults check_coverage(const Edit& edit, Change& change);

/// G2, the elevations: the vertical distance of two piecewise linear surfaces is greatest at a
/// vertex of one or where two of their edges cross; it is measured at all of those.
Faults check_surface(const Edit& edit, const Change& change);

/// G3: each segment is covered by chains of constrained edges wherever it is on the mesh, and so is
/// each constraint from before; no other edge is constrained.
Faults check_chains(const Edit& edit);

/// OWN: each vertex of a chain along a path with elevations of its own has the elevation of such a
/// path there. Not looked at where old constraints keep theirs, nor with a snap distance, where
/// what is near cannot be told from what is meant.
Faults check_elevations(const Edit& edit);

/// Where a segment a-b of a request crosses a constrained edge, or one along which the surface
/// bends or ends, of the mesh before that request.
struct ActualCrossing {
    core::Point2 a;
    core::Point2 b;
    core::Point2 p;
};

/// Adds those of the shapes' segments. `flat`: no bend is what bends by no more than that.
void add_actual_crossings(const Snapshot& before, std::span<const core::Shape> shapes, double flat,
                          std::vector<ActualCrossing>& crossings);

/// For `forced`: vertices are not counted.
inline constexpr std::size_t kUncounted = SIZE_MAX;

/// G8: new vertices since `origin` are at distinct points of the shapes given since, or where
/// their segments cross edges of `origin` or each other, or come within `snap` of them; at each
/// such place no more than there are reasons. `forced` more are let pass at a place.
/// G8 speaks of the mesh before each request: where the chains that earlier requests left, or the
/// creases into which rounding bent a facet, are crossed more often than their segments are, those
/// crossings are reasons too.
Faults check_economy(const Snapshot& origin, const core::MeshData& after,
                     std::span<const core::Shape> shapes, std::span<const ActualCrossing> crossings,
                     double reach, double snap, std::size_t forced);

}  // namespace tinsmith::verify
