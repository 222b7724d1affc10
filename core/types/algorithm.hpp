// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tinsmith::core {

/// Which algorithm this core is: it grows by one with each change after which any operation on any
/// mesh may give other bytes than before, and only then. Who keeps operations to do them again
/// later keeps the number with them. The test of digests names it: a digest that changes asks for
/// it.
inline constexpr std::uint32_t kAlgorithm = 2;

}  // namespace tinsmith::core
