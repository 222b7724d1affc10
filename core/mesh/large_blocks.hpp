// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tinsmith::core {

/// Blocks of this size and more are worth pages of their own.
inline constexpr std::size_t kLargeBlock = std::size_t{4} << 20;

/// Memory in the largest pages that the system has to give, zeroed as it is touched. On a mesh that
/// is walked through once the translation of addresses is a good part of what a look costs, and a
/// large page holds the translations of 512 usual ones. Begins where such a page does.
/// Throws std::bad_alloc. Cost: what is touched for the first time.
void* allocate_large_block(std::size_t bytes);
/// Requires: the block came from `allocate_large_block` for as many bytes.
void free_large_block(void* block, std::size_t bytes) noexcept;

}  // namespace tinsmith::core
