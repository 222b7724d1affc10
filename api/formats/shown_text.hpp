// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api {

/// Bytes of a file of unknown encoding, to be quoted in a fault's detail: what is not printable
/// ASCII becomes a question mark, so that the detail is UTF-8 whatever they are.
inline std::string shown(std::string_view bytes) {
    constexpr std::size_t kMost = 200;  // quoting cuts it shorter
    std::string text(bytes.substr(0, kMost));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return json::quoted(text);
}

}  // namespace tinsmith::api
