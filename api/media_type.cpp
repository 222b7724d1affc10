// SPDX-License-Identifier: Apache-2.0
#include "api/media_type.hpp"

#include <vector>

#include "api/field_list.hpp"

namespace tinsmith::api {

namespace {

/// 0: does not match; the greater, the more specific the match.
int specificity(const Weighted& range, std::string_view offer) {
    if (range.name == offer) return 3;
    if (range.name == "*/*") return 1;
    const std::size_t slash = range.name.find('/');
    const bool is_family = range.name.substr(slash) == "/*";
    const bool same_family = offer.substr(0, slash + 1) == range.name.substr(0, slash + 1);
    return is_family && same_family ? 2 : 0;
}

double weight_of(std::string_view offer, const std::vector<Weighted>& ranges) {
    int best = 0;
    double weight = 0.0;
    for (const Weighted& range : ranges) {
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
    return lower_case(take_part(content_type, ';'));
}

std::optional<std::size_t> choose_media_type(std::string_view accept,
                                             std::span<const std::string_view> offers) {
    if (trimmed(accept).empty()) return 0;
    std::vector<Weighted> ranges;
    while (!accept.empty()) {
        auto range = parse_weighted(take_part(accept, ','));
        if (range && range->name.find('/') != std::string::npos) {
            ranges.push_back(std::move(*range));
        }
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
