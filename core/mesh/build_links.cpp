// SPDX-License-Identifier: Apache-2.0
// How a mesh's triangles find their neighbours as it is built.
#include <algorithm>
#include <string>

#include "core/mesh/tin_builder.hpp"

namespace tinsmith::core {

/// Sides by their first vertex, in each of its buckets by their second: O(n log d) however many
/// triangles share a vertex.
void TinBuilder::sort_sides() {
    const std::size_t count = data_.triangles.size();
    first_side_.assign(data_.vertices.size() + 1, 0);
    for (const auto& triangle : data_.triangles)
        for (const std::uint32_t v : triangle)
            ++first_side_[v + 1];
    for (std::size_t v = 0; v < data_.vertices.size(); ++v)
        first_side_[v + 1] += first_side_[v];
    sides_.resize(3 * count);
    std::vector<std::uint32_t> filled(first_side_.begin(), first_side_.end() - 1);
    for (std::uint32_t t = 0; t < count; ++t)
        for (unsigned i = 0; i < 3; ++i)
            sides_[filled[data_.triangles[t][i]]++] = Side({t}, i);
    const auto by_destination = [this](Side l, Side r) {
        const VertexId a = tin_.destination(l), b = tin_.destination(r);
        return a != b ? a < b : l < r;
    };
    for (std::size_t v = 0; v < data_.vertices.size(); ++v)
        std::sort(sides_.begin() + first_side_[v], sides_.begin() + first_side_[v + 1],
                  by_destination);
}

/// The first side from one vertex to another; invalid where there is none.
Side TinBuilder::find_side(VertexId from, VertexId to) const {
    const auto end = sides_.begin() + first_side_[from.index() + 1];
    const auto found =
        std::lower_bound(sides_.begin() + first_side_[from.index()], end, to,
                         [this](Side s, VertexId v) { return tin_.destination(s) < v; });
    return found != end && tin_.destination(*found) == to ? *found : Side{};
}

void TinBuilder::add_triangles() {
    const std::size_t count = data_.triangles.size();
    tin_.triangles_.clear();
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = data_.triangles[t];
        tin_.triangles_.push_back(
            {{VertexId{a}, VertexId{b}, VertexId{c}}, {}, {static_cast<std::uint32_t>(t)}, 0});
    }
    tin_.next_facet_ = static_cast<std::uint32_t>(count);
}

/// Links a mesh that is as nearly all are: each vertex has one fan, none of which passes over
/// itself. So no edge has two triangles on one side of it, and nothing needs to be sorted. Of
/// others, of their faults and of constrained edges it makes nothing, and says so.
bool TinBuilder::link_plainly() {
    if (!data_.constraints.empty()) return false;
    tin_.reserve_growth(data_.vertices.size(), data_.triangles.size());
    add_triangles();
    if (join_sides()) collect_fans();
    if (errors_.empty() && copies_.empty() && tin_.vertices_.size() == data_.vertices.size())
        return true;
    errors_.clear();
    copies_.clear();
    tin_.vertices_.clear();
    return false;
}

/// Each side is joined to the one that came before it and goes the other way. Until that comes a
/// side waits at its vertex, in a list that goes on where its twin will be. False: a list is too
/// long to be looked through again and again.
bool TinBuilder::join_sides() {
    constexpr int kLongest = 64;
    std::vector<Side> waiting(data_.vertices.size());
    const auto next_of = [this](Side s) -> Side& {
        return tin_.triangles_[s.triangle().index()].twins[s.index()];
    };
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const VertexId from = tin_.origin(side), to = tin_.destination(side);
            Side* place = &waiting[to.index()];
            for (int steps = 0; place->valid() && tin_.destination(*place) != from; ++steps) {
                if (steps == kLongest) return false;
                place = &next_of(*place);
            }
            if (place->valid()) {
                const Side twin = *place;
                *place = next_of(twin);
                next_of(twin) = side;
                next_of(side) = twin;
            } else {
                next_of(side) = waiting[from.index()];
                waiting[from.index()] = side;
            }
        }
    }
    for (Side side : waiting) {
        while (side.valid()) {
            const Side next = next_of(side);
            next_of(side) = {};
            side = next;
        }
    }
    return true;
}

void TinBuilder::link() {
    const std::size_t count = data_.triangles.size();
    tin_.reserve_growth(data_.vertices.size(), count);
    add_triangles();
    sort_sides();
    for (std::uint32_t t = 0; t < count; ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const VertexId from = tin_.origin(side);
            const VertexId to = tin_.destination(side);
            if (find_side(from, to) == side) {
                tin_.triangles_[t].twins[i] = find_side(to, from);
                continue;
            }
            triangle_fault(ErrorCode::EdgeNotManifold, t,
                           "repeats the edge from vertex " +
                               std::to_string(vertex_name(from.value)) + " to " +
                               std::to_string(vertex_name(to.value)) +
                               " of another triangle on the same side: they overlap");
        }
    }
    if (errors_.empty()) mark_constraints();
    sides_ = {};
    first_side_ = {};
}

void TinBuilder::mark_constraints() {
    for (std::size_t i = 0; i < data_.constraints.size(); ++i) {
        const auto [from, to] = data_.constraints[i];
        Side side;
        if (std::max(from, to) < data_.vertices.size()) {
            side = find_side({from}, {to});
            if (!side.valid()) side = find_side({to}, {from});
        }
        if (!side.valid()) {
            fault(ErrorCode::VertexIndexOutOfRange,
                  "constraint " + std::to_string(i) + " joins vertices " + std::to_string(from) +
                      " and " + std::to_string(to) + ", which no edge of the mesh does",
                  {});
            continue;
        }
        for (const Side s : {side, tin_.twin(side)})
            if (s.valid()) tin_.triangles_[s.triangle().index()].marks |= 1U << s.index();
    }
}

}  // namespace tinsmith::core
