// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/services.hpp"

namespace tinsmith::server {

/// All figures of the process as Prometheus reads them: what `Metrics` counted and was given, what
/// the services hold at the moment, and the process itself.
/// Waits for no edit and no encoding: of all locks that are taken here, none is held for longer
/// than a search in a map or a copy of a few words.
std::string scrape(Services& services);

}  // namespace tinsmith::server
