// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "api/fault.hpp"

namespace tinsmith::server {

/// Writes faults to standard error, a line for each, so that people find the place:
///     lake.geojson: /geometry/coordinates/0/3: RING_TOO_SHORT: ... (at 739012.5, 4027310)
void complain(const std::string& file, const api::Faults& faults);

void complain(const std::string& text);

}  // namespace tinsmith::server
