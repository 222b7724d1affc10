// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tinsmith::api {

/// The media type of a Content-Type header, lower-case and without parameters:
/// "Application/JSON; charset=utf-8" is "application/json".
std::string media_type_of(std::string_view content_type);

/// Which of `offers` (lower-case media types, most wanted first) an Accept header prefers, by
/// RFC 9110 12.5.1: the most specific range that matches an offer gives its weight, the greatest
/// weight wins, and the order of the offers decides a tie. An empty header accepts anything.
/// Nothing: none is acceptable. Ranges that cannot be read are passed over.
std::optional<std::size_t> choose_media_type(std::string_view accept,
                                             std::span<const std::string_view> offers);

}  // namespace tinsmith::api
