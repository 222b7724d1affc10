// SPDX-License-Identifier: Apache-2.0
#include "api/media_type.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

namespace tinsmith::api {

namespace {

struct Range {
    std::string type;     ///< "model/gltf-binary", "model/*" or "*/*"
    double weight = 1.0;  ///< 0: not acceptable
};

std::string_view trimmed(std::string_view text) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_space(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return out;
}

/// Takes what stands before the separator off the front of `rest`.
std::string_view take(std::string_view& rest, char separator) {
    const std::size_t end = std::min(rest.find(separator), rest.size());
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return trimmed(part);
}

/// The weight between 0 and 1; a broken one makes the range unreadable.
std::optional<double> parse_weight(std::string_view text) {
    double weight = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, weight, std::chars_format::fixed);
    if (error != std::errc() || stop != end || !(weight >= 0.0 && weight <= 1.0)) {
        return std::nullopt;
    }
    return weight;
}

std::optional<Range> parse_range(std::string_view text) {
    Range range;
    range.type = lower(take(text, ';'));
    if (range.type.find('/') == std::string::npos) return std::nullopt;
    while (!text.empty()) {
        std::string_view parameter = take(text, ';');
        const std::string name = lower(take(parameter, '='));
        if (name != "q") continue;
        const auto weight = parse_weight(parameter);
        if (!weight) return std::nullopt;
        range.weight = *weight;
    }
    return range;
}

/// 0: does not match; the greater, the more specific the match.
int specificity(const Range& range, std::string_view offer) {
    if (range.type == offer) return 3;
    if (range.type == "*/*") return 1;
    const std::size_t slash = range.type.find('/');
    const bool is_family = range.type.substr(slash) == "/*";
    const bool same_family = offer.substr(0, slash + 1) == range.type.substr(0, slash + 1);
    return is_family && same_family ? 2 : 0;
}

double weight_of(std::string_view offer, const std::vector<Range>& ranges) {
    int best = 0;
    double weight = 0.0;
    for (const Range& range : ranges) {
        const int match = specificity(range, offer);
        if (match > best) {
            best = match;
            weight = range.weight;
        }
    }
    return weight;
}

}  // namespace

std::string media_type_of(std::string_view content_type) {
    return lower(take(content_type, ';'));
}

std::optional<std::size_t> choose_media_type(std::string_view accept,
                                             std::span<const std::string_view> offers) {
    if (trimmed(accept).empty()) return 0;
    std::vector<Range> ranges;
    while (!accept.empty()) {
        if (auto range = parse_range(take(accept, ','))) ranges.push_back(std::move(*range));
    }
    std::optional<std::size_t> chosen;
    double best = 0.0;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        const double weight = weight_of(offers[i], ranges);
        if (weight > best) {
            best = weight;
            chosen = i;
        }
    }
    return chosen;
}

}  // namespace tinsmith::api
