// SPDX-License-Identifier: Apache-2.0
#include "api/content_coding.hpp"

#include <optional>
#include <string>

#include "api/field_list.hpp"

namespace tinsmith::api {

bool accepts_gzip(std::string_view accept_encoding) {
    std::optional<double> named;
    std::optional<double> star;
    std::optional<double> identity;
    while (!accept_encoding.empty()) {
        const auto element = parse_weighted(take_part(accept_encoding, ','));
        if (!element) continue;
        if (element->name == "gzip" || element->name == "x-gzip") named = element->weight;
        if (element->name == "*") star = element->weight;
        if (element->name == "identity") identity = element->weight;
    }
    const double weight = named ? *named : star.value_or(0.0);
    return weight > 0.0 && weight >= identity.value_or(0.0);
}

}  // namespace tinsmith::api
