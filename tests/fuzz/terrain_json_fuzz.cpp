// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a value or with faults, in bounded memory.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "api/formats/points_mesh.hpp"
#include "api/formats/terrain_json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    limits.max_polygon_vertices = 10'000;
    auto parsed =
        tinsmith::api::read_terrain_json({reinterpret_cast<const char*>(data), size}, limits);
    if (parsed) parsed = tinsmith::api::triangulated(*std::move(parsed), limits);
    if (!parsed && (parsed.faults().empty() || parsed.faults().size() > limits.max_faults))
        std::abort();
    return 0;
}
