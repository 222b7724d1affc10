// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// Two digits for each byte, lower-case.
std::string hex_of(std::string_view bytes);

/// The bytes again; nothing where the text is no such digits.
std::optional<std::string> from_hex(std::string_view text);

}  // namespace tinsmith::server
