// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a mesh whose indices are in range, or with faults.
#include "api/formats/landxml_reader.hpp"
#include "tests/fuzz/mesh_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return tinsmith::fuzz::read_mesh(data, size, tinsmith::api::read_landxml);
}
