// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>

#include "core/edit/plane.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"
#include "core/regions/region.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// The strip between the part that takes a change in full and the part that does not move: a TIN
/// holds no upright wall. Its outer and inner line are edges of the mesh; a vertex between them at
/// the plan distance d from the full part takes the share 1 - d / width of the change, and none
/// beyond: new = old + (target - old) * (1 - d / width). All lengths in the session's unit.
struct Strip {
    enum class Kind {
        Rim,    ///< inside the polygon's border: the ring is inside, within it the change is full
        Taper,  ///< outside: the polygon with its border takes it in full, the ring takes nothing
    };
    Kind kind = Kind::Rim;
    double width = 0.0;  ///< above 0
    Shape ring;          ///< at `width` from the border; its inside is even-odd
    Shape border;        ///< Taper: the lines that distance is from. Rim: empty, it is the ring.
};

/// Gives the region new elevations.
struct ElevationEdit {
    struct Offset {
        double by = 0.0;
    };
    std::variant<Plane, Offset> change;
    /// Nothing: the border's vertices move as well, and the triangles outside that touch them tilt.
    std::optional<Strip> strip;
};

/// Draws each vertex of the region towards its neighbours, pass by pass, all at once in each:
/// new = old + sum(w * (neighbour - old)) / sum(w) / 2 with w = 1 / plan distance, over all that it
/// shares an edge with. What does not move is a neighbour, too. Edges stay.
struct SmoothEdit {
    std::uint32_t passes = 1;
    bool moves_border = false;  ///< otherwise what is strictly inside moves, and nothing else
};

/// Takes the region out of the mesh, or all but the region.
struct TrimEdit {
    bool keeps_inside = false;
};

using RegionEdit = std::variant<ElevationEdit, SmoothEdit, TrimEdit>;

struct EditLimits {
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    IdLimits ids = {};
    std::function<bool()> cancelled = {};   ///< asked now and then; true stops the work
    std::function<double()> clock_ms = {};  ///< for the report alone, never in a decision
    /// Told now and then what share is done. It may fall back where a ring is integrated again.
    std::function<void(double)> progress = {};
};

/// What an edit did. Volumes and areas are in the session's unit, areas in plan.
struct EditReport {
    std::uint64_t vertices_moved = 0;      ///< up or down
    std::uint64_t triangles_affected = 0;  ///< tilted, raised or lowered
    std::uint64_t vertices_added =
        0;  ///< by the strip's ring, or as copies where a removal parts the mesh
    std::uint64_t triangles_added = 0;
    std::uint64_t vertices_removed = 0;
    std::uint64_t triangles_removed = 0;
    double cut = 0.0;   ///< what the ground lost, exact on the triangles; of a removal: nothing
    double fill = 0.0;  ///< what it gained, likewise
    double area_affected = 0.0;         ///< of the triangles affected, or removed
    double max_elevation_change = 0.0;  ///< of any vertex
    StageTimes time_ms;                 ///< of the ring; zero where the caller gave no clock
    double apply_ms = 0.0;              ///< all the rest; with the above the whole edit
};

/// Edits the mesh inside a polygon that was integrated into it, or nothing where it fails. Where
/// `undo` is given it takes what `take_back` needs.
///
/// Laws: with a rim nothing outside the polygon and nothing of its border changes, by a bit, nor
/// with a taper anything outside the ring or of it; without a strip no vertex but those of the
/// region moves. A vertex that takes a change in full takes it exactly: on a level all of them are
/// level. Vertices that a removal parted stay at one elevation. Each triangle with a vertex that
/// moved gets a facet of its own.
/// Requires: `outline` as integrating it reported it on this mesh.
/// Errors: nothing of the region on the mesh; nothing of the mesh left; an elevation out of range;
/// budgets; cancelled.
/// Cost: linear in the mesh, with little for each triangle that is not the region's.
Result<EditReport> edit_region(Tin& tin, const Outline& outline, Winding winding,
                               const RegionEdit& edit, const EditLimits& limits,
                               Undo* undo = nullptr);

}  // namespace tinsmith::core
