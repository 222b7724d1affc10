// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/integrate/integrator.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// Integrates one shape of closed paths like `integrate`; but one that meets the mesh nowhere, and
/// may lie around it or beside it, is no error: all of it is outside.
Result<Report> integrate_ring(Tin& tin, const Shape& shape, const IntegrateOptions& options,
                              Undo* undo = nullptr);

}  // namespace tinsmith::core
