// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace tinsmith::server {

/// One member of a line. The name is ours, of small letters and underscores; a text may be
/// anyone's.
struct LogField {
    std::string_view name;
    std::variant<std::string_view, std::int64_t, double> value;

    LogField(std::string_view of, std::string_view text) : name(of), value(text) {}
    LogField(std::string_view of, const std::string& text) : name(of), value(text) {}
    LogField(std::string_view of, const char* text) : name(of), value(std::string_view(text)) {}
    LogField(std::string_view of, double number) : name(of), value(number) {}
    template <std::integral Whole>
    LogField(std::string_view of, Whole number)
        : name(of), value(static_cast<std::int64_t>(number)) {}
};

/// The members of a JSON object, without its braces, in ASCII: `"a":"text","b":1`.
///
/// Laws: whatever the texts hold, a line of it is one line and one object, and no text ends before
/// its quote: control characters, quotes, backslashes and all that is not ASCII are escaped; bytes
/// that are not UTF-8 become U+FFFD; texts are cut after kLongestLogText bytes.
std::string json_members(std::span<const LogField> fields);

/// The same for people: ` a=text b=1`, texts by `sanitized`, in quotes where they have blanks.
std::string text_members(std::span<const LogField> fields);

inline constexpr std::size_t kLongestLogText = 600;

/// Printable ASCII as it is, the rest as \xNN; cut after so many bytes.
std::string sanitized(std::string_view text, std::size_t longest = 200);

}  // namespace tinsmith::server
