// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace tinsmith::api {

/// Whether the bytes begin with a whole zlib stream (RFC 1950) that holds exactly so many bytes.
/// Cost: one decompression up to that size, in constant memory.
bool inflates_to(std::string_view deflated, std::uint64_t size);

}  // namespace tinsmith::api
