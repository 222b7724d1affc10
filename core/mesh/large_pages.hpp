// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tinsmith::core {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// What so many bytes of a large block take: a page that is begun is there whole.
/// Requires: far less than all that can be addressed.
constexpr std::size_t in_large_pages(std::size_t bytes) {
    return (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

}  // namespace tinsmith::core
