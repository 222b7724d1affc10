// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/integrate/options.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "tests/verify/verifier.hpp"

namespace tinsmith::test {

/// What an operation was and did.
struct Operation {
    std::span<const core::Shape> shapes;
    const core::IntegrateOptions& options;
    const core::Report& report;
    const core::Tin& after;
};

/// The structure's own laws, which plain buffers do not show: what is broken, in words.
std::vector<std::string> check_valid(const core::Tin& tin);

/// What is broken, in words; empty when all guarantees hold. The verifier holds the mesh before and
/// goes on to the one after. `forced`: see `verify::check_economy`.
std::vector<std::string> check_guarantees(verify::Verifier& verifier, const Operation& op,
                                          std::size_t forced = 0);

}  // namespace tinsmith::test
