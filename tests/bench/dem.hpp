// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace tinsmith::bench {

/// Writes the bundled terrain, bilinear between its posts, as a GeoTIFF of float32 that makes about
/// so many triangles; how many they are. The same every time.
std::size_t write_dem(const std::string& path, std::size_t triangles);

}  // namespace tinsmith::bench
