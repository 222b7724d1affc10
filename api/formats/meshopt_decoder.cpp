// SPDX-License-Identifier: Apache-2.0
#include "api/formats/meshopt_decoder.hpp"

#include <cstring>

#include <meshoptimizer.h>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api {

namespace {

Fault fault_of(std::string detail) {
    return {"GLTF_MESHOPT", "The view packed by meshoptimizer " + std::move(detail), {}};
}

/// How many elements so many bytes can stand for at most: of vertices 16 in a row take two bits
/// for each of their bytes; each triangle takes a byte, and so does each index.
std::size_t most_elements(const GltfMeshopt& view) {
    if (view.mode == "ATTRIBUTES") return view.length * 64 / view.stride + 1;
    return view.mode == "TRIANGLES" ? view.length * 3 : view.length;
}

}  // namespace

std::variant<std::string, Fault> decode_meshopt(const GltfMeshopt& view, std::string_view packed,
                                                std::size_t most) {
    const bool is_vertices = view.mode == "ATTRIBUTES";
    const bool is_triangles = view.mode == "TRIANGLES";
    if (!is_vertices && !is_triangles && view.mode != "INDICES")
        return fault_of("is of no known mode: ATTRIBUTES, TRIANGLES or INDICES.");
    const bool fits = is_vertices ? view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0
                                  : view.stride == 2 || view.stride == 4;
    if (!fits || (is_triangles && view.count % 3 != 0))
        return fault_of("has a byteStride or a count that its mode does not allow.");
    if (view.count > most_elements(view) || view.count > most)
        return fault_of("promises " + std::to_string(view.count) +
                        " elements, more than its bytes can hold or this server allows.");
    const bool is_exponential = view.filter == "EXPONENTIAL";
    if (!is_exponential && !view.filter.empty() && view.filter != "NONE")
        return fault_of("has the filter " + json::quoted(view.filter) +
                        ", which is not for positions.");
    std::string out(view.count * view.stride, '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(packed.data());
    const int status =
        is_vertices
            ? meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, from, packed.size())
        : is_triangles
            ? meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, from, packed.size())
            : meshopt_decodeIndexSequence(out.data(), view.count, view.stride, from, packed.size());
    if (status != 0) return fault_of("is damaged.");
    if (is_exponential && is_vertices) meshopt_decodeFilterExp(out.data(), view.count, view.stride);
    return out;
}

}  // namespace tinsmith::api
