// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// One broken law of a TIN: which, where, in words.
struct Violation {
    std::string law;  ///< "orientation", "adjacency", "vertex", "fan", "marks", "coordinate"
    std::string detail;
};

/// Every law of `Tin` that does not hold, at most `limit`; empty for a valid mesh.
/// Independent of how the mesh was made: it reads slots and the exact predicate, nothing else.
/// Cost: linear.
std::vector<Violation> check_tin(const Tin& tin, std::size_t limit = 100);

}  // namespace tinsmith::core
