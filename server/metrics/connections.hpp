// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/http/connection.hpp"

namespace prometheus {
class Collectable;
}

namespace tinsmith::server {

/// Open connections and those that were closed to make room, as Prometheus asks for them.
std::shared_ptr<const prometheus::Collectable> figures_of(
    std::shared_ptr<const ConnectionTotals> totals);

}  // namespace tinsmith::server
