// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// A request target taken apart: "/a/b%20c?x=1" is the path "/a/b%20c" and the query {x: 1}.
struct Target {
    std::string path;  ///< as sent, still percent-encoded
    std::vector<NameValue> query;
};

/// Nothing where an escape is broken, a decoded byte is a control character, or the path does not
/// start with "/". Cost: linear.
std::optional<Target> parse_target(std::string_view text);

/// "%41b" as "Ab"; "+" means a space in queries only. Nothing where an escape is broken.
std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space);

/// The segments between slashes, decoded: "/v1/sessions" is {"v1", "sessions"}, "/" is {}.
/// A trailing slash makes a last empty segment. Nothing where an escape is broken.
std::optional<std::vector<std::string>> split_path(std::string_view path);

}  // namespace tinsmith::server
