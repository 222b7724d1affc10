// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace tinsmith::api {

/// The whole text as a number, to the nearest double, with or without a sign in front. "nan" and
/// "inf" are some, as `std::from_chars` has it; "1e999" and "" are none.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) return std::nullopt;
    return value;
}

}  // namespace tinsmith::api
