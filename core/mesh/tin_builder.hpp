// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/build.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/error.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// Builds in passes, each of which needs what the earlier ones proved.
class TinBuilder {
  public:
    TinBuilder(const MeshData& data, const MeshNames& names) : data_(data), names_(names) {}

    Result<Tin> build() {
        check_coordinates();
        check_triangles();
        if (!errors_.empty()) return std::move(errors_);
        if (!link_plainly()) {
            link();
            if (!errors_.empty()) return std::move(errors_);
            collect_fans();
            if (!errors_.empty()) return std::move(errors_);
        }
        check_overlaps();
        if (!errors_.empty()) return std::move(errors_);
        index();
        return std::move(tin_);
    }

  private:
    void fault(ErrorCode code, std::string detail, ErrorPlace place) {
        if (errors_.size() < kMaxFaults) errors_.push_back({code, std::move(detail), place});
    }
    static std::size_t name(std::span<const std::uint32_t> names, std::size_t i) {
        return i < names.size() ? names[i] : i;
    }
    std::size_t triangle_name(std::size_t t) const { return name(names_.triangles, t); }
    std::size_t vertex_name(std::size_t v) const { return name(names_.vertices, v); }
    void triangle_fault(ErrorCode code, std::size_t t, const std::string& what) {
        ErrorPlace place;
        place.triangle = triangle_name(t);
        const std::uint32_t v = data_.triangles[t][0];
        if (v < data_.vertices.size()) place.position = data_.vertices[v].plan();
        fault(code, "triangle " + std::to_string(*place.triangle) + " " + what, place);
    }
    void vertex_fault(ErrorCode code, std::size_t v, const std::string& what) {
        ErrorPlace place;
        place.vertex = vertex_name(v);
        place.position = data_.vertices[v].plan();
        fault(code, "vertex " + std::to_string(*place.vertex) + " " + what, place);
    }

    void check_coordinates();
    void check_triangles();
    void add_triangles();
    bool link_plainly();
    bool join_sides();
    void sort_sides();
    Side find_side(VertexId from, VertexId to) const;
    void link();
    void mark_constraints();
    void collect_fans();
    void collect_fan(Side first);
    bool holds_direction(Side s, Point2 p) const;
    void check_copies();
    Side side_at(VertexId v) const;
    void folded_fault(VertexId named);
    void check_overlaps();
    void index();
    void index_hints();

    const MeshData& data_;
    const MeshNames& names_;
    Tin tin_;
    Errors errors_;
    std::vector<bool> bad_vertex_;           ///< whose coordinates are at fault
    std::vector<std::uint32_t> first_side_;  ///< where a vertex's bucket begins in sides_
    std::vector<Side> sides_;
    std::vector<bool> corner_seen_;  ///< by the code of the side that starts there
    std::vector<std::pair<VertexId, VertexId>> copies_;  ///< vertex, copy for a further fan
};

}  // namespace tinsmith::core
