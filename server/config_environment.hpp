// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tinsmith::server {

/// What is wrong with a variable of the environment that the command line's library passed over:
/// newer releases take what they cannot read for what is not there, and a limit would be none.
/// Empty: nothing. Requires: it has parsed.
std::string refused_variable(const CLI::App& app);

}  // namespace tinsmith::server
