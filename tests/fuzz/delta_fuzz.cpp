// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a delta or with faults, in bounded memory; a delta that it
// took is written again as the same bytes, and in JSON.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "api/formats/delta.hpp"

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    const std::string_view bytes{reinterpret_cast<const char*>(data), size};
    const auto delta = tinsmith::api::read_delta(bytes, limits);
    if (!delta) {
        require(!delta.faults().empty() && delta.faults().size() <= limits.max_faults);
        return 0;
    }
    require(delta->new_vertices <= limits.max_vertices);
    require(delta->new_triangles <= limits.max_triangles);
    require(tinsmith::api::write_delta(*delta) == bytes);
    require(!tinsmith::api::write_delta_json(*delta).empty());
    return 0;
}
