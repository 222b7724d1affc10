// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
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

/// Bytes that are to be kept as a text in UTF-8 of at most `most` bytes: each byte that belongs to
/// no character becomes a question mark, and a character that does not fit is left out.
inline std::string text_in_utf8(std::string_view bytes, std::size_t most) {
    const auto byte = [&bytes](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
    const auto length_at = [&](std::size_t at) -> std::size_t {
        const unsigned char lead = byte(at);
        if (lead < 0x80) return 1;
        const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
        if (lead < 0xC2 || lead > 0xF4 || at + length > bytes.size()) return 0;
        for (std::size_t i = 1; i < length; ++i)
            if ((byte(at + i) & 0xC0U) != 0x80U) return 0;
        // Too long for what they say, halves of pairs, and beyond the last character.
        const unsigned char next = byte(at + 1);
        const bool is_none = (lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) ||
                             (lead == 0xF0 && next < 0x90) || (lead == 0xF4 && next > 0x8F);
        return is_none ? 0 : length;
    };
    std::string text;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t length = length_at(at);
        if (text.size() + std::max<std::size_t>(length, 1) > most) break;
        if (length == 0)
            text.push_back('?');
        else
            text.append(bytes.substr(at, length));
        at += std::max<std::size_t>(length, 1);
    }
    return text;
}

}  // namespace tinsmith::api
