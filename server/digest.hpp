// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// The SHA-256 of the parts, each preceded by its length so that moving a byte from one to the next
/// makes another digest. 32 bytes. Throws std::bad_alloc where the library has no memory.
std::string sha256_of(std::span<const std::string_view> parts);

/// The SHA-256 of the text and of nothing else, as `sha256sum` gives it. 32 bytes. Throws as above.
std::string plain_sha256_of(std::string_view text);

/// Whether two texts are the same, in a time that their lengths alone decide: how long it takes
/// does not say where they differ.
bool same_in_constant_time(std::string_view one, std::string_view other);

}  // namespace tinsmith::server
