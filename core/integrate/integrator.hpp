// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

enum class Improve {
    None,    ///< leave what the march made
    Strict,  ///< swap within facets only: best triangles, surface unmoved
};

enum class Outside {
    Skip,    ///< integrate what meets the mesh, list the rest
    Reject,  ///< refuse the request if any part is outside
};

struct IntegrateOptions {
    Improve improve = Improve::Strict;
    Outside outside = Outside::Skip;
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    /// Asked now and then; true stops the work and leaves the mesh as it was.
    std::function<bool()> cancelled;
    /// Milliseconds from any fixed start; for the report alone, never in a decision.
    std::function<double()> clock_ms;
};

/// Integrates all shapes, in order, or none of them (guarantees G1-G6, G8).
Result<Report> integrate(Tin& tin, std::span<const Shape> shapes, const IntegrateOptions& options);

}  // namespace tinsmith::core
