// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// The SHA-256 of the parts, each preceded by its length so that moving a byte from one to the next
/// makes another digest. 32 bytes. Throws std::bad_alloc where the library has no memory.
std::string sha256_of(std::span<const std::string_view> parts);

}  // namespace tinsmith::server
