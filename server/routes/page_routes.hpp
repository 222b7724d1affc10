// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// Under this path are the files of the page. They belong to the page alone, not to the interface:
/// /openapi.json does not describe them, and no other route begins so.
inline constexpr std::string_view kPageFolder = "/viewer/";

std::vector<Route> make_page_routes(Services& services);

}  // namespace tinsmith::server
