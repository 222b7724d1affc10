// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/replaced.hpp"

#include <algorithm>

namespace tinsmith::core {

namespace {

/// Keeps the first of each id, which is what was there before the request.
template <typename Entries>
void keep_first_of_each(Entries& entries) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& l, const auto& r) { return l.first < r.first; });
    entries.erase(std::unique(entries.begin(), entries.end(),
                              [](const auto& l, const auto& r) { return l.first == r.first; }),
                  entries.end());
}

template <typename Entries, typename Id>
auto find_id(const Entries& entries, Id id) {
    const auto found =
        std::lower_bound(entries.begin(), entries.end(), id,
                         [](const auto& entry, Id wanted) { return entry.first < wanted; });
    return found != entries.end() && found->first == id ? found : entries.end();
}

void sort_out(std::vector<Replaced::Edge>& edges) {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace

Replaced::Replaced(const Tin& tin, std::span<const UndoRecord> records) : tin_(tin) {
    vertex_count_ = records.front().vertex_count;
    triangle_count_ = records.front().triangle_count;
    split_count_ = records.front().split_count;
    for (const UndoRecord& record : records) {
        for (const auto& [id, old] : record.triangles)
            if (id.index() < triangle_count_) old_.emplace_back(id, &old);
        for (const auto& [id, old] : record.vertices)
            if (id.index() < vertex_count_) old_vertices_.emplace_back(id, &old);
    }
    keep_first_of_each(old_);
    keep_first_of_each(old_vertices_);
    for (const auto& [id, old] : old_) {
        if (tin.triangle(id).vertices == old->vertices) continue;
        removed_.push_back(old->vertices);
        added_.push_back(id);
    }
    for (std::size_t t = triangle_count_; t < tin.triangle_count(); ++t)
        added_.push_back({static_cast<std::uint32_t>(t)});
    collect_lines();
}

Point3 Replaced::before(VertexId v) const {
    const auto found = find_id(old_vertices_, v);
    return found != old_vertices_.end() ? found->second->point() : tin_.vertex(v).point();
}

const Tin::Triangle& Replaced::triangle_before(TriangleId t) const {
    const auto found = find_id(old_, t);
    return found != old_.end() ? *found->second : tin_.triangle(t);
}

void Replaced::collect_lines() {
    for (const auto& [id, old] : old_) {
        for (unsigned i = 0; i < 3; ++i) {
            const VertexId a = old->vertices[i], b = old->vertices[Side::next_of(i)];
            const Edge edge{std::min(a, b), std::max(a, b)};
            const bool is_constrained = (old->marks >> i & 1U) != 0;
            if (is_constrained) constraints_.push_back(edge);
            const Side twin = old->twins[i];
            if (is_constrained || !twin.valid() ||
                triangle_before(twin.triangle()).facet != old->facet)
                lines_.push_back(edge);
        }
    }
    sort_out(constraints_);
    sort_out(lines_);
}

}  // namespace tinsmith::core
