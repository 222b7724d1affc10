// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/edit_answer.hpp"
#include "core/edit/region_edit.hpp"
#include "core/integrate/integrator.hpp"
#include "server/delta.hpp"
#include "server/locks.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// An edit of what is inside a polygon that another operation brought. The rings that it needs are
/// kept with it, so that running it again gives the same bytes.
struct EditOperation {
    api::EditAnswer asked;  ///< its report is empty, but for the time that making the rings took
    core::RegionEdit edit;
};

/// What a session was told to do, whole enough to be done again. Each kind is one alternative; the
/// functions below say what a kind has to know of itself.
using Operation = std::variant<PolygonsOperation, LocksOperation, EditOperation>;
using OperationPtr = std::shared_ptr<const Operation>;

/// What one run of an operation may cost. Never kept with the operation.
struct RunLimits {
    std::function<bool()> cancelled = {};
    std::function<double()> clock_ms = {};
    std::function<void(double)> progress = {};  ///< told now and then what share is done
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    /// Refuse an operation that finds nothing of what it is about. One that is run again and no
    /// longer finds it does nothing, as the refused one would have done.
    bool must_find = false;
    bool is_bound_by_memory = false;  ///< that is why there are no more new triangles
};

/// An operation that the mesh holds, with all that takes it back bit for bit. Never changed once
/// made, so that forks of a session share it.
struct Applied {
    std::uint64_t version = 0;  ///< of the session when it was first done
    OperationPtr operation;
    std::shared_ptr<const core::Report> report;     ///< of a polygons request, else null
    std::shared_ptr<const LocksDone> locks;         ///< of a locks request, else null
    std::shared_ptr<const api::EditAnswer> answer;  ///< of an edit, else null
    core::Undo undo;
    std::shared_ptr<const SlotChanges> written;
    std::size_t lasting_bytes = 0;  ///< about what operation and report hold in memory
    std::size_t record_bytes = 0;   ///< about what taking it back holds
};
using AppliedPtr = std::shared_ptr<const Applied>;

/// The polygon of that id which an operation before this one brought, as it lies in the mesh.
using PolygonFinder = std::function<std::optional<Polygon>(std::string_view)>;

/// Does the operation. An error, or an exception, leaves the mesh as it was.
/// Requires: the polygons that it works on are found.
core::Result<AppliedPtr> run(core::Tin& tin, std::uint64_t version, OperationPtr operation,
                             const RunLimits& limits, const PolygonFinder& find);

/// The polygon of that id, if the operation brought it.
std::optional<Polygon> polygon_of(const Applied& applied, std::string_view id);

/// Whether the operation works on a polygon that another one brought.
bool names_polygon(const Operation& operation, std::string_view id);

/// What is left of an operation when a polygon has never been.
struct Remainder {
    bool brought_it = false;
    OperationPtr rest;  ///< null: nothing
};
Remainder without_polygon(const OperationPtr& operation, std::string_view id);

/// About what these hold in memory.
std::size_t held_bytes(const core::Shape& shape);
std::size_t held_bytes(const core::ShapeReport& report);
std::size_t held_bytes(const LocksDone& done);
std::size_t held_bytes(const SlotChanges& written);

/// The ids that the operation brings; none for kinds that bring no polygon.
const std::vector<std::string>& polygon_ids(const Operation& operation);

}  // namespace tinsmith::server
