// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a mesh that can be built or with faults, in bounded memory.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "api/formats/csv.hpp"
#include "api/formats/points_mesh.hpp"
#include "core/mesh/build.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    tinsmith::api::looks_like_csv(bytes);
    auto parsed = tinsmith::api::read_csv(bytes, {}, limits);
    if (parsed) parsed = tinsmith::api::triangulated(*std::move(parsed), limits);
    if (parsed) {
        if (!tinsmith::core::build_tin(parsed->mesh)) std::abort();
        return 0;
    }
    if (parsed.faults().empty() || parsed.faults().size() > limits.max_faults) std::abort();
    // Details are for people: plain text whatever the bytes.
    for (const tinsmith::api::Fault& fault : parsed.faults())
        for (const char c : fault.detail)
            if (c < ' ' || c > '~') std::abort();
    return 0;
}
