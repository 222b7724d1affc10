// SPDX-License-Identifier: Apache-2.0
// What a surgery keeps of the mesh before it, and how that comes back.
#include <algorithm>
#include <utility>

#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

Surgery::Surgery(Tin& tin) : tin_(tin) {
    record_.vertex_count = tin.vertices_.size();
    record_.triangle_count = tin.triangles_.size();
    record_.boundary_changes = tin.boundary_.changes();
    record_.split_count = tin.constraint_splits_.size();
    record_.next_facet = tin.next_facet_;
    record_.next_name = tin.next_name_;
    record_.facet_error = tin.facet_error_;
    record_.bounds = tin.bounds_;
}

void Surgery::expect(std::size_t vertices) {
    record_.triangles.reserve(record_.triangles.size() + 2 * vertices);
}

Surgery::~Surgery() {
    if (open_) roll_back();
}

UndoRecord Surgery::commit() {
    if (bounds_are_stale_) {
        const auto [low, high] = std::minmax_element(
            tin_.vertices_.begin(), tin_.vertices_.end(),
            [](const Tin::Vertex& l, const Tin::Vertex& r) { return l.z < r.z; });
        tin_.bounds_.min.z = low->z;
        tin_.bounds_.max.z = high->z;
    }
    for (const auto& [id, old] : record_.triangles)
        if (id.index() < tin_.triangles_.size())
            tin_.triangles_[id.index()].marks &= ~kTransientBits;
    for (std::size_t i = record_.triangle_count; i < tin_.triangles_.size(); ++i)
        tin_.triangles_[i].marks &= ~kTransientBits;
    open_ = false;
    return std::move(record_);
}

void Surgery::roll_back() {
    undo(tin_, std::move(record_));
    open_ = false;
}

void Surgery::undo(Tin& tin, const UndoRecord& record) {
    // What may fail for want of memory comes before what is changed.
    const RemovalRecord* const removal = record.removal.get();
    BoundaryIndex boundary;
    std::vector<TriangleId> components;
    if (removal != nullptr) {
        tin.vertices_.reserve(record.vertex_count);
        tin.triangles_.reserve(record.triangle_count);
        tin.names_.reserve(record.vertex_count);
        tin.constraint_splits_.reserve(record.split_count);
        boundary = removal->boundary;
        components = removal->components;
    }
    restore(tin, record, std::move(boundary), std::move(components));
}

void Surgery::undo(Tin& tin, UndoRecord&& record) noexcept {
    if (RemovalRecord* const removal = record.removal.get())
        restore(tin, record, std::move(removal->boundary), std::move(removal->components));
    else
        restore(tin, record, {}, {});
}

/// Requires: there is room for what the mesh held before.
void Surgery::restore(Tin& tin, const UndoRecord& record, BoundaryIndex&& boundary,
                      std::vector<TriangleId>&& components) {
    const RemovalRecord* const removal = record.removal.get();
    if (removal == nullptr) tin.boundary_.take_back(record.boundary_changes);
    tin.vertices_.resize(record.vertex_count);
    tin.triangles_.resize(record.triangle_count);
    for (const auto& [id, old] : record.triangles)
        tin.triangles_[id.index()] = old;
    for (auto entry = record.vertices.rbegin(); entry != record.vertices.rend(); ++entry)
        tin.vertices_[entry->first.index()] = entry->second;
    tin.constraint_splits_.resize(record.split_count);
    tin.next_facet_ = record.next_facet;
    tin.facet_error_ = record.facet_error;
    tin.bounds_ = record.bounds;
    if (!tin.names_.empty()) tin.names_.resize(record.vertex_count);
    tin.next_name_ = record.next_name;
    if (removal == nullptr) return;

    if (!removal->was_renumbered) tin.names_.clear();
    for (const auto& [slot, name] : removal->names)
        tin.names_[slot.index()] = name;
    std::copy(removal->splits.begin(), removal->splits.end(),
              tin.constraint_splits_.begin() + static_cast<std::ptrdiff_t>(removal->named_splits));
    tin.named_splits_ = removal->named_splits;
    tin.gone_ends_.resize(removal->gone_ends);
    tin.built_vertex_count_ = removal->built_vertex_count;
    for (const auto& [cell, hint] : removal->hints)
        tin.hints_[cell] = hint;
    tin.boundary_ = std::move(boundary);
    tin.components_ = std::move(components);
}

}  // namespace tinsmith::core
