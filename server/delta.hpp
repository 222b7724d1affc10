// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "api/formats/delta.hpp"
#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"

namespace tinsmith::server {

/// The slots in which a mesh differs before and after an operation; the same both ways.
struct SlotChanges {
    std::size_t vertex_floor = 0;          ///< slots from here on were made, or are gone
    std::size_t triangle_floor = 0;        ///< likewise
    std::vector<std::uint32_t> vertices;   ///< slots below that moved, in order, each once
    std::vector<std::uint32_t> triangles;  ///< slots below with other corners, likewise
};

/// What the operation changed that a client sees: positions and corners, not neighbours and marks.
/// Requires: `undo` is of the newest operation on the mesh.
SlotChanges slot_changes(const core::Tin& tin, const core::Undo& undo);

/// The state of a mesh from which a delta leads to what it is now.
struct DeltaStart {
    std::uint64_t version = 0;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
};

/// What leads from there to the mesh as it is now, at version `to`, given all changes in between;
/// or the whole mesh where that takes fewer bytes. Cost: what is in it, sorted.
api::MeshDelta make_delta(const core::Tin& tin, const DeltaStart& from, std::uint64_t to,
                          std::span<const std::shared_ptr<const SlotChanges>> changes);

/// All slots in order, for a client that has nothing or not enough.
api::MeshDelta make_whole(const core::Tin& tin, const DeltaStart& from, std::uint64_t to);

}  // namespace tinsmith::server
