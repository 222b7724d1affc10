// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace tinsmith::api {

struct JsonLimits {
    std::size_t values = 0;  ///< of any kind, names among them
    int depth = 0;
};

struct JsonSound {
    bool is_sound = true;
    bool is_too_much = false;    ///< the limits were met; otherwise its syntax is wrong
    std::size_t wrong_byte = 0;  ///< counted from 1
};

/// Whether a document can be read and is within limits, before the library builds it in memory.
/// The library's own way to watch it being built goes through all of a list again after each object
/// in it. Cost: linear.
JsonSound look_through_json(std::string_view text, JsonLimits limits);

}  // namespace tinsmith::api
