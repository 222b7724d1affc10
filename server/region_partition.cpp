// SPDX-License-Identifier: Apache-2.0
#include "server/region_partition.hpp"

#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/regions/constraint_history.hpp"
#include "core/regions/region.hpp"
#include "server/polygon_groups.hpp"
#include "server/region_allowance.hpp"

namespace tinsmith::server {

PartitionGround partition_ground(const core::Tin& tin, std::span<const Polygon> all) {
    PartitionGround ground{{core::Tin(tin), {}}, {}};
    for (const Polygon& polygon : all) {
        if (!polygon.has_inside()) continue;
        ground.regions.polygons.push_back({polygon.id(), true, true, polygon.request.winding,
                                           polygon.outline(), polygon.own_report()});
        ground.features.push_back(
            {polygon.id(), polygon.origin().client_id, polygon.origin().properties, 0.0, 0.0});
    }
    return ground;
}

std::size_t partition_bytes(const core::Tin& tin, std::span<const Polygon> all) {
    constexpr std::size_t kParsed = 32;  // bytes for each of the text, as measured
    std::size_t sum = region_bytes(tin, all);
    for (const Polygon& polygon : all)
        sum += kParsed * (polygon.origin().properties.size() + polygon.origin().client_id.size());
    return sum;
}

core::Result<api::RegionPartition> find_partition(PartitionGround ground, std::string unit,
                                                  const RegionLimits& limits) {
    const core::Tin& tin = ground.regions.tin;
    api::RegionPartition made;
    made.features = std::move(ground.features);
    made.unit = std::move(unit);
    made.set_of.resize(tin.triangle_count(), PolygonGroups::kNone);
    if (made.features.empty()) return made;

    RegionAllowance allowance(limits);
    const core::ConstraintHistory history(tin);
    PolygonGroups groups;
    for (std::size_t i = 0; i < made.features.size(); ++i) {
        if (!allowance.goes_on()) return *allowance.refused();
        const RegionGround::Drawn& polygon = ground.regions.polygons[i];
        const core::Region region = core::find_region(
            tin, history, {polygon.shape, polygon.report.chains, polygon.report.outside},
            polygon.winding);
        made.features[i].plan_area = region.plan_area;
        made.features[i].surface_area = region.surface_area;
        if (!allowance.spend(region.triangles.size())) return *allowance.refused();
        const std::size_t groups_before = groups.count();
        groups.begin(i);
        for (const core::TriangleId t : region.triangles)
            made.set_of[t.index()] = groups.with(made.set_of[t.index()]);
        if (!allowance.spend_ids(groups.count() - groups_before)) return *allowance.refused();
    }
    // The groups that are left, numbered by their first triangle; none of them is the first set.
    std::unordered_map<PolygonGroups::Id, std::uint32_t> numbers{{PolygonGroups::kNone, 0}};
    for (std::uint32_t& group : made.set_of) {
        const auto [found, is_new] =
            numbers.try_emplace(group, static_cast<std::uint32_t>(made.sets.size()));
        if (is_new) {
            const std::size_t ids = groups.size(group);
            // Each is told with its primitive, as text: that takes the room of many triangles.
            if (!allowance.spend_ids(ids) || !allowance.spend_told(ids))
                return *allowance.refused();
            std::vector<std::uint32_t> set;
            for (const std::size_t member : groups.members(group))
                set.push_back(static_cast<std::uint32_t>(member));
            made.sets.push_back(std::move(set));
        }
        group = found->second;
    }
    return made;
}

}  // namespace tinsmith::server
