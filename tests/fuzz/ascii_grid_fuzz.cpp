// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a grid or with faults, in bounded memory; both ways from the
// grid lead to the same mesh. The first byte chooses what the caller says of the system.
#include <cstdint>
#include <string_view>

#include "api/formats/ascii_grid.hpp"
#include "tests/fuzz/grid_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    tinsmith::api::TerrainOptions options;
    if (data[0] % 4 == 1) options.crs = "EPSG:2263";
    if (data[0] % 4 == 2) options.crs = "EPSG:4326";
    if (data[0] % 4 == 2) options.project = "auto";
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    return tinsmith::fuzz::check_grid(tinsmith::api::read_ascii_grid(text, options, limits),
                                      limits);
}
