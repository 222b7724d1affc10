// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/tin.hpp"

namespace tinsmith::core {

MeshData Tin::to_data() const {
    MeshData data;
    data.vertices.reserve(vertices_.size());
    for (const Vertex& v : vertices_) data.vertices.push_back(v.point());
    data.triangles.reserve(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const Triangle& triangle = triangles_[t];
        data.triangles.push_back(
            {triangle.vertices[0].value, triangle.vertices[1].value, triangle.vertices[2].value});
        if ((triangle.marks & 7U) == 0) continue;
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const Side other = twin(side);
            // Each edge once: from its lower side, or from its only one.
            if (!is_constrained(side) || (other.valid() && other < side)) continue;
            data.constraints.push_back({origin(side).value, destination(side).value});
        }
    }
    return data;
}

std::size_t Tin::memory_bytes() const {
    return vertices_.size() * sizeof(Vertex) + triangles_.size() * sizeof(Triangle);
}

}  // namespace tinsmith::core
