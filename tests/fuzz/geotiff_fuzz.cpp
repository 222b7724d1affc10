// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a grid or with faults, in bounded memory; both ways from the
// grid lead to the same mesh.
#include <cstdint>
#include <string_view>

#include "api/formats/geotiff.hpp"
#include "tests/fuzz/grid_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    limits.max_polygon_vertices = 10'000;
    return tinsmith::fuzz::check_grid(
        tinsmith::api::read_geotiff({reinterpret_cast<const char*>(data), size}, limits), limits);
}
