// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// The bytes as gzip at the cheapest level, the same every time (no name, no date). Nothing where
/// the library fails: then they go out as they are. Cost: about 10 ms for a megabyte of JSON.
std::optional<std::string> gzip(std::string_view bytes);

}  // namespace tinsmith::server
