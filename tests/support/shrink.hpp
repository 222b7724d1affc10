// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tests/support/case_file.hpp"

namespace tinsmith::test {

/// A smaller case of which `fails` is still true: requests, shapes, paths, points and triangles are
/// taken away, and coordinates rounded, until nothing more can be. Requires: fails(given).
Case shrink(const Case& given, const std::function<bool(const Case&)>& fails);

}  // namespace tinsmith::test
