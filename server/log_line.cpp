// SPDX-License-Identifier: Apache-2.0
#include "server/log_line.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tinsmith::server {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::string_view kCut = "...";

void append_unit(std::string& out, std::uint32_t unit) {
    out += "\\u";
    for (int shift = 12; shift >= 0; shift -= 4)
        out.push_back(kDigits[(unit >> static_cast<unsigned>(shift)) & 15U]);
}

void append_escaped(std::string& out, char32_t point) {
    constexpr char32_t kFirstPair = 0x10000;
    if (point < kFirstPair) {
        append_unit(out, point);
    } else {
        append_unit(out, 0xd800U + ((point - kFirstPair) >> 10U));
        append_unit(out, 0xdc00U + ((point - kFirstPair) & 0x3ffU));
    }
}

/// The code point that begins the text and its bytes; U+FFFD and one byte where none does. Neither
/// the long forms of short ones nor halves of pairs nor what is beyond Unicode are code points.
std::pair<char32_t, std::size_t> first_point(std::string_view text) {
    constexpr std::pair<char32_t, std::size_t> kNone{0xfffd, 1};
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return kNone;
    char32_t point = lead & (0x7fU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0U) != 0x80U) return kNone;
        point = (point << 6U) | (byte(i) & 0x3fU);
    }
    constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
    const bool is_half = point >= 0xd800 && point <= 0xdfff;
    if (point < kLeast[length] || is_half || point > 0x10ffff) return kNone;
    return {point, length};
}

void append_json_text(std::string& out, std::string_view text) {
    const bool is_cut = text.size() > kLongestLogText;
    std::string_view rest = text.substr(0, kLongestLogText);
    out.push_back('"');
    while (!rest.empty()) {
        const auto [point, bytes] = first_point(rest);
        if (point == '"' || point == '\\') {
            out.push_back('\\');
            out.push_back(static_cast<char>(point));
        } else if (point >= 0x20 && point < 0x7f) {
            out.push_back(static_cast<char>(point));
        } else {
            append_escaped(out, point);
        }
        rest.remove_prefix(bytes);
    }
    if (is_cut) out += kCut;
    out.push_back('"');
}

/// A time or a size: three decimals are plenty.
std::string text_of(double number) {
    if (!std::isfinite(number)) return "null";
    std::array<char, 64> text{};
    const auto [end, error] =
        std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, 3);
    return error == std::errc() ? std::string(text.data(), end) : "null";
}

bool wants_quotes(std::string_view text) {
    return text.empty() || text.find_first_of(" =") != text.npos;
}

}  // namespace

std::string json_members(std::span<const LogField> fields) {
    std::string out;
    for (const auto& [name, value] : fields) {
        if (!out.empty()) out.push_back(',');
        out.append("\"").append(name).append("\":");
        if (const auto* text = std::get_if<std::string_view>(&value)) {
            append_json_text(out, *text);
        } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
            out += std::to_string(*whole);
        } else {
            out += text_of(std::get<double>(value));
        }
    }
    return out;
}

std::string text_members(std::span<const LogField> fields) {
    std::string out;
    for (const auto& [name, value] : fields) {
        out.append(" ").append(name).append("=");
        if (const auto* text = std::get_if<std::string_view>(&value)) {
            const std::string safe = sanitized(*text);
            out += wants_quotes(safe) ? '"' + safe + '"' : safe;
        } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
            out += std::to_string(*whole);
        } else {
            out += text_of(std::get<double>(value));
        }
    }
    return out;
}

std::string sanitized(std::string_view text, std::size_t longest) {
    std::string out;
    for (const char c : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f && c != '"' && c != '\\') {
            out.push_back(c);
        } else {
            out += "\\x";
            out.push_back(kDigits[byte >> 4]);
            out.push_back(kDigits[byte & 15U]);
        }
    }
    if (text.size() > longest) out += kCut;
    return out;
}

}  // namespace tinsmith::server
