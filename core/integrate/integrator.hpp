// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/integrate/options.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// Integrates all shapes, in order, or none of them (guarantees G1-G8 in tests/support). Where
/// `undo` is given it takes what `take_back` needs.
/// Errors: coordinates out of range; nothing of the request meets the mesh; parts outside where
/// they are to be rejected; no mesh of doubles that holds a segment; budgets; cancelled.
/// Cost: linear in crossings and input vertices, and in what is swapped.
Result<Report> integrate(Tin& tin, std::span<const Shape> shapes, const IntegrateOptions& options,
                         Undo* undo = nullptr);

/// Takes a committed operation back, bit for bit, in time proportional to what it changed.
/// Requires: it is the newest on this mesh that was not taken back.
void take_back(Tin& tin, const Undo& undo);
/// The same for records that are not needed any more, in the mesh that they were made in: nothing
/// is copied, so that it cannot fail for want of memory. Requires: no other holds them.
void take_back(Tin& tin, Undo&& undo) noexcept;

}  // namespace tinsmith::core
