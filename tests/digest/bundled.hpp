// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/integrate/shape.hpp"

namespace tinsmith::digest {

/// The polygons and lines of tests/data, in order of their names; empty where one cannot be read.
/// They lie between 731728, 4004667 and 762853, 4037452.
std::vector<core::Shape> read_bundled(const std::string& folder);

}  // namespace tinsmith::digest
