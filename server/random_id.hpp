// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// Two lower-case digits for each of `bytes` bytes from the system's random source.
std::string random_hex(std::size_t bytes);

/// A random UUID (version 4): nobody guesses the id of another's session.
std::string random_uuid();

/// True for an id that a client may bring along: 1 to 64 of [A-Za-z0-9._-].
bool is_sane_id(std::string_view id);

}  // namespace tinsmith::server
