// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/keys/asker.hpp"

namespace CLI {
class App;
}

namespace tinsmith::server {

/// A flag for each quota that a key may have.
void add_quotas(CLI::App& app, KeyQuotas& quotas);

}  // namespace tinsmith::server
