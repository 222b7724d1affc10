// SPDX-License-Identifier: Apache-2.0
#include "api/field_list.hpp"

#include <algorithm>
#include <charconv>

namespace tinsmith::api {

namespace {

/// A broken weight makes the element unreadable.
std::optional<double> parse_weight(std::string_view text) {
    double weight = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, weight, std::chars_format::fixed);
    if (error != std::errc() || stop != end || !(weight >= 0.0 && weight <= 1.0)) {
        return std::nullopt;
    }
    return weight;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_space(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return out;
}

std::string_view take_part(std::string_view& rest, char separator) {
    const std::size_t end = std::min(rest.find(separator), rest.size());
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return trimmed(part);
}

std::optional<Weighted> parse_weighted(std::string_view text) {
    Weighted element;
    element.name = lower_case(take_part(text, ';'));
    if (element.name.empty()) return std::nullopt;
    while (!text.empty()) {
        std::string_view parameter = take_part(text, ';');
        const std::string name = lower_case(take_part(parameter, '='));
        if (name != "q") continue;
        const auto weight = parse_weight(parameter);
        if (!weight) return std::nullopt;
        element.weight = *weight;
    }
    return element;
}

}  // namespace tinsmith::api
