// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "server/http_message.hpp"
#include "server/routes/step.hpp"

namespace tinsmith::server {

/// The query parameters of a list.
inline constexpr std::array<std::string_view, 2> kPageParameters{"limit", "cursor"};

inline constexpr std::size_t kMostOfAPage = 1000;  ///< and as many as there are without `limit`

/// Which part of a list is asked for.
struct Page {
    std::size_t limit = kMostOfAPage;
    std::string after;  ///< the last id of the page before; empty: from the beginning
};

/// Reads `limit` (1 to kMostOfAPage) and `cursor`, or 400 that names all that is wrong. A cursor is
/// opaque to clients; one of another kind of list is refused. It says where the last page ended and
/// stays good whatever comes and goes meanwhile.
Step<Page> require_page(const Request& request, std::string_view kind);

/// The value of Link that leads on after `last`.
std::string next_link(const Request& request, std::string_view kind, std::size_t limit,
                      std::string_view last);

}  // namespace tinsmith::server
