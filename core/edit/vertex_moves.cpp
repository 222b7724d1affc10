// SPDX-License-Identifier: Apache-2.0
#include "core/edit/vertex_moves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/edit/cut_and_fill.hpp"
#include "core/integrate/options.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

/// The moves that move anything, or what is wrong with them.
std::optional<Error> settle(const Tin& tin, std::span<const VertexMove> moves,
                            std::vector<VertexMove>& real) {
    for (const auto& [v, z] : moves) {
        if (!std::isfinite(z) || std::fabs(z) > kCoordinateLimit) {
            ErrorPlace place;
            place.position = tin.plan(v);
            return Error{ErrorCode::CoordinateOutOfRange,
                         "the new elevation at this position would be beyond 1e15; nothing was "
                         "changed",
                         place};
        }
        const double kept = std::fabs(z) < kCoordinateFloor ? 0.0 : z;
        if (kept != tin.vertex(v).z) real.push_back({v, kept});
    }
    return std::nullopt;
}

std::vector<TriangleId> triangles_around(const Tin& tin, std::span<const VertexMove> moves) {
    std::vector<TriangleId> found;
    for (const VertexMove& move : moves) {
        for_each_side_at(tin, move.vertex, [&](Side side) {
            for (const Side s : {side, tin.twin(side)})
                if (s.valid()) found.push_back(s.triangle());
        });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

/// By how much the vertex sinks.
double fall_of(const Tin& tin, std::span<const VertexMove> moves, VertexId v) {
    const auto move = std::ranges::lower_bound(moves, v, {}, &VertexMove::vertex);
    return move != moves.end() && move->vertex == v ? tin.vertex(v).z - move->z : 0.0;
}

}  // namespace

std::optional<Error> move_vertices(Surgery& surgery, std::span<const VertexMove> moves,
                                   const IdLimits& ids, EditReport& report) {
    const Tin& tin = surgery.tin();
    std::vector<VertexMove> real;
    if (auto error = settle(tin, moves, real)) return error;
    const std::vector<TriangleId> affected = triangles_around(tin, real);
    if (tin.next_facet() + affected.size() > ids.facets)
        return Error{ErrorCode::IdBudget, kNoFacetLeft, {}};

    CutAndFill sums;
    for (const TriangleId t : affected) {
        const auto& [a, b, c] = tin.triangle(t).vertices;
        sums.add(compensated_doubled_area(tin.plan(a), tin.plan(b), tin.plan(c)) / 2.0,
                 {fall_of(tin, real, a), fall_of(tin, real, b), fall_of(tin, real, c)});
    }
    for (const auto& [v, z] : real) {
        const double change = std::fabs(z - tin.vertex(v).z);
        report.max_elevation_change = std::max(report.max_elevation_change, change);
        surgery.set_elevation(v, z);
    }
    for (const TriangleId t : affected)
        surgery.give_fresh_facet(t);
    report.vertices_moved += real.size();
    report.triangles_affected += affected.size();
    report.cut += sums.cut();
    report.fill += sums.fill();
    report.area_affected += sums.area();
    return std::nullopt;
}

}  // namespace tinsmith::core
