// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/tin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mesh/large_pages.hpp"

namespace tinsmith::core {

Tin::Tin(const Tin& other)
    : constraint_splits_(other.constraint_splits_),
      named_splits_(other.named_splits_),
      names_(other.names_),
      next_name_(other.next_name_),
      gone_ends_(other.gone_ends_),
      next_facet_(other.next_facet_),
      facet_error_(other.facet_error_),
      built_vertex_count_(other.built_vertex_count_),
      bounds_(other.bounds_),
      boundary_(other.boundary_),
      components_(other.components_),
      hints_(other.hints_),
      hint_origin_(other.hint_origin_),
      hint_columns_(other.hint_columns_),
      hints_per_x_(other.hints_per_x_),
      hints_per_y_(other.hints_per_y_) {
    reserve_growth(other.vertices_.size(), other.triangles_.size());
    vertices_.assign(other.vertices_.begin(), other.vertices_.end());
    triangles_.assign(other.triangles_.begin(), other.triangles_.end());
}

Tin& Tin::operator=(const Tin& other) {
    if (this != &other) *this = Tin(other);
    return *this;
}

void Tin::reserve_growth(std::size_t vertices, std::size_t triangles) {
    vertices_.reserve(vertices + vertices / 2);
    triangles_.reserve(triangles + triangles / 2);
}

BoundaryIndex Tin::index_boundary() const {
    std::vector<Side> boundary;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            if (!triangles_[t].twins[i].valid()) boundary.push_back({{t}, i});
    return index_boundary(boundary);
}

BoundaryIndex Tin::index_boundary(std::span<const Side> sides) const {
    BoundaryIndex index(bounds_.min.plan(), bounds_.max.plan(), sides.size());
    for (const Side s : sides)
        index.add(origin(s), plan(origin(s)), plan(destination(s)));
    return index;
}

void Tin::lay_out_hints() {
    const double cells = static_cast<double>(triangles_.size()) / 3.0;
    const std::size_t columns = static_cast<std::size_t>(std::clamp(std::sqrt(cells), 1.0, 8192.0));
    hint_columns_ = columns;
    hint_origin_ = bounds_.min.plan();
    hints_per_x_ = static_cast<double>(columns) / (bounds_.max.x - bounds_.min.x);
    hints_per_y_ = static_cast<double>(columns) / (bounds_.max.y - bounds_.min.y);
    hints_.assign(columns * columns, {});
}

void Tin::fill_hints() {
    TriangleId before{0};
    for (TriangleId& hint : hints_) {
        if (!hint.valid()) hint = before;
        before = hint;
    }
}

MeshData Tin::to_data() const {
    MeshData data;
    data.vertices.reserve(vertices_.size());
    for (const Vertex& v : vertices_)
        data.vertices.push_back(v.point());
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
    const auto held = [](const auto& slots) {
        const std::size_t bytes = slots.size() * sizeof(slots[0]);
        const bool is_large = slots.capacity() * sizeof(slots[0]) >= kLargeBlock;
        return is_large ? in_large_pages(bytes) : bytes;
    };
    return held(vertices_) + held(triangles_) + hints_.size() * sizeof(TriangleId) +
           constraint_splits_.size() * sizeof(ConstraintSplit) + names_.size() * sizeof(VertexId) +
           gone_ends_.size() * sizeof(GoneEnd) + boundary_.memory_bytes();
}

}  // namespace tinsmith::core
