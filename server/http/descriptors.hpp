// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tinsmith::server {

/// Raises what the process may open to what it needs for so many connections, as far as the system
/// allows (RLIMIT_NOFILE). Returns how many connections there may be.
std::size_t allow_connections(std::size_t wanted);

}  // namespace tinsmith::server
