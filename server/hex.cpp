// SPDX-License-Identifier: Apache-2.0
#include "server/hex.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

}  // namespace

std::string hex_of(std::string_view bytes) {
    std::string out;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        out.push_back(kDigits[byte >> 4]);
        out.push_back(kDigits[byte & 15U]);
    }
    return out;
}

std::optional<std::string> from_hex(std::string_view text) {
    std::string out;
    for (; text.size() >= 2; text.remove_prefix(2)) {
        const std::size_t high = kDigits.find(text[0]);
        const std::size_t low = kDigits.find(text[1]);
        if (high == kDigits.npos || low == kDigits.npos) return std::nullopt;
        out.push_back(static_cast<char>(high * 16 + low));
    }
    return text.empty() ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace tinsmith::server
