// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "api/fault.hpp"
#include "api/terrain.hpp"

namespace tinsmith::server {

/// Writes faults to standard error, a line for each, so that people find the place:
///     lake.geojson: /geometry/coordinates/0/3: RING_TOO_SHORT: ... (at 739012.5, 4027310)
void complain(const std::string& file, const api::Faults& faults);

void complain(const std::string& text);

/// Writes to standard error what was mended of a terrain and what its reader passed over.
void tell_of(const std::string& file, const api::Terrain& terrain);

}  // namespace tinsmith::server
