// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/services.hpp"

namespace tinsmith::server {

/// Where the bundled terrain is: beside the program where it is installed
/// (<prefix>/share/tinsmith), else in the tree that it was built from.
std::string bundled_terrain();

/// Loads a terrain as session "demo". Returns the reason where that fails, else an empty text.
std::string load_demo(Services& services, const std::string& path);

}  // namespace tinsmith::server
