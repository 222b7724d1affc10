// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// `"abc"` or `W/"abc"` (RFC 9110 8.8.3).
struct EntityTag {
    bool weak = false;
    std::string opaque;  ///< what stands between the quotes
};

/// The value of If-Match or If-None-Match.
struct EntityTags {
    bool any = false;             ///< "*"
    std::vector<EntityTag> tags;  ///< in the order given
};

/// All fields of that lower-case name as the one list that they mean (RFC 9110 5.3); nothing where
/// there is none.
std::optional<std::string> combined_field(const Request& request, std::string_view name);

/// Reads a list of entity tags: empty elements are passed over, commas and spaces within quotes
/// belong to the tag. Nothing where it is malformed: bare words, `w/`, an open quote, "*" among
/// others. Cost: linear.
std::optional<EntityTags> parse_entity_tags(std::string_view field);

}  // namespace tinsmith::server
