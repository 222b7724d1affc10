// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// Every path of the service, in one table. Requires: `services` outlives the routes.
std::vector<Route> make_routes(Services& services);

}  // namespace tinsmith::server
