// SPDX-License-Identifier: Apache-2.0
#include "server/region_shapes.hpp"

#include <unordered_map>
#include <utility>

#include "api/edge_chains.hpp"
#include "core/regions/constraint_history.hpp"
#include "core/regions/region.hpp"
#include "core/regions/region_border.hpp"
#include "server/polygon_groups.hpp"
#include "server/region_allowance.hpp"

namespace tinsmith::server {

namespace {

api::Ring3 ring_of(const core::Tin& tin, const std::vector<core::VertexId>& vertices) {
    api::Ring3 ring;
    ring.reserve(vertices.size() + 1);
    for (const core::VertexId v : vertices)
        ring.push_back(tin.vertex(v).point());
    ring.push_back(ring.front());
    return ring;
}

}  // namespace

core::Result<std::vector<api::RegionShape>> find_shapes(PartitionGround ground,
                                                        const RegionLimits& limits) {
    const core::Tin& tin = ground.regions.tin;
    RegionAllowance allowance(limits);
    const core::ConstraintHistory history(tin);
    std::vector<api::RegionShape> shapes;
    for (std::size_t i = 0; i < ground.features.size(); ++i) {
        if (!allowance.goes_on()) return *allowance.refused();
        const RegionGround::Drawn& polygon = ground.regions.polygons[i];
        const core::Region region = core::find_region(
            tin, history, {polygon.shape, polygon.report.chains, polygon.report.outside},
            polygon.winding);
        if (!allowance.spend(region.triangles.size())) return *allowance.refused();
        api::RegionShape& shape = shapes.emplace_back();
        shape.feature = std::move(ground.features[i]);
        shape.feature.plan_area = region.plan_area;
        shape.feature.surface_area = region.surface_area;
        shape.triangles = region.triangles.size();
        for (const core::BorderedPart& part : core::border_of(tin, region.triangles)) {
            std::vector<api::Ring3>& rings = shape.polygons.emplace_back();
            rings.push_back(ring_of(tin, part.outer));
            for (const auto& hole : part.holes)
                rings.push_back(ring_of(tin, hole));
        }
    }
    return shapes;
}

ConstraintGround constraint_ground(const core::Tin& tin, std::span<const Polygon> all) {
    ConstraintGround ground{core::Tin(tin), {}};
    for (const Polygon& polygon : all)
        ground.polygons.push_back({polygon.id(), polygon.own_report().chains});
    return ground;
}

core::Result<std::vector<api::ConstraintLine>> find_constraint_lines(const ConstraintGround& ground,
                                                                     const RegionLimits& limits) {
    const core::Tin& tin = ground.tin;
    RegionAllowance allowance(limits);
    const core::ConstraintHistory history(tin);
    PolygonGroups groups;
    std::unordered_map<std::uint64_t, PolygonGroups::Id> along;
    for (std::size_t i = 0; i < ground.polygons.size(); ++i) {
        groups.begin(i);
        for (const core::Chain& chain : ground.polygons[i].chains) {
            const auto edges = history.edges_along(chain.vertices);
            if (!allowance.spend(edges.size())) return *allowance.refused();
            for (const auto& [a, b] : edges) {
                PolygonGroups::Id& group = along[core::edge_key(a, b)];
                group = groups.with(group);
            }
        }
    }
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> group_of;  ///< twice the group, and one more where it is locked
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const core::Side side(core::TriangleId{t}, i), twin = tin.twin(side);
            if (!tin.is_constrained(side) || (twin.valid() && twin < side)) continue;
            const core::VertexId a = tin.origin(side), b = tin.destination(side);
            const auto found = along.find(core::edge_key(a, b));
            const PolygonGroups::Id group =
                found == along.end() ? PolygonGroups::kNone : found->second;
            edges.push_back({a.value, b.value});
            group_of.push_back(2 * group + (tin.is_locked(side) ? 1 : 0));
        }
    }
    std::unordered_map<std::uint64_t, std::size_t> number_of;
    for (std::size_t i = 0; i < edges.size(); ++i)
        number_of.emplace(core::edge_key(core::VertexId{edges[i][0]}, core::VertexId{edges[i][1]}),
                          i);
    std::vector<api::ConstraintLine> lines;
    for (const auto& vertices :
         api::chain_edges(edges, [&](std::size_t edge) { return group_of[edge]; })) {
        if (!allowance.spend(vertices.size())) return *allowance.refused();
        api::ConstraintLine& line = lines.emplace_back();
        for (const std::uint32_t v : vertices)
            line.positions.push_back(tin.vertex(core::VertexId{v}).point());
        const std::uint32_t group = group_of[number_of.at(
            core::edge_key(core::VertexId{vertices[0]}, core::VertexId{vertices[1]}))];
        line.is_locked = group % 2 == 1;
        if (!allowance.spend_ids(groups.size(group / 2))) return *allowance.refused();
        for (const std::size_t polygon : groups.members(group / 2))
            line.polygons.push_back(ground.polygons[polygon].id);
    }
    return lines;
}

}  // namespace tinsmith::server
