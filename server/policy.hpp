// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tinsmith::server {

/// What the operator decides about how clients may behave.
struct Policy {
    bool require_if_match = false;          ///< edits that do not name their version are refused
    std::vector<std::string> cors_origins;  ///< "https://maps.example", or "*" for everyone
};

}  // namespace tinsmith::server
