// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/mesh/tin.hpp"
#include "core/mesh/undo_record.hpp"

namespace tinsmith::core {

/// Degrees of a step: the smallest angle of a triangle is 60 at most.
inline constexpr unsigned kAngleStep = 5;

/// How many triangles have their smallest angle (3D) in each step, from 0 degrees on. An angle that
/// is a billionth of a step below the next one, as rounding leaves it, is counted there.
using AngleSteps = std::array<std::uint64_t, 60 / kAngleStep>;

/// The triangles that a request replaced or that have a corner which it moved, each once, as they
/// were and as they are.
struct AngleCounts {
    AngleSteps before{};
    AngleSteps after{};
};

/// Requires: records of one request, from its first on, none taken back.
/// Cost: n log n in the triangles recorded. It is no part of a request's report, for it has to look
/// at every one of them closely.
AngleCounts count_angles(const Tin& tin, std::span<const UndoRecord> records);

}  // namespace tinsmith::core
