// SPDX-License-Identifier: Apache-2.0
#include "server/regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/regions/constraint_history.hpp"
#include "server/operation.hpp"
#include "server/polygon_groups.hpp"
#include "server/region_allowance.hpp"

namespace tinsmith::server {

namespace {

/// Indices of polygons, in growing order.
using Group = std::vector<std::size_t>;

/// Around a polygon as it was drawn, with room for what snapping and rounding did to it.
struct Box {
    core::Point2 low{HUGE_VAL, HUGE_VAL};
    core::Point2 high{-HUGE_VAL, -HUGE_VAL};

    bool meets(const Box& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y;
    }
};

Box box_of(const Polygon& polygon) {
    Box box;
    double largest = 0.0;
    for (const core::Path& path : polygon.outline().paths) {
        for (const core::Point2& p : path.points) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
        }
    }
    constexpr double kRounding = 1e-9;  // of the coordinates, far above what rounding does
    const double room = 2.0 * polygon.request.options.snap + kRounding * largest;
    return {{box.low.x - room, box.low.y - room}, {box.high.x + room, box.high.y + room}};
}

/// The polygons whose boxes meet one of those wanted, these included.
Group near_ones(std::span<const Polygon> all, std::span<const std::size_t> wanted) {
    std::vector<Box> boxes;
    boxes.reserve(wanted.size());
    for (const std::size_t i : wanted)
        boxes.push_back(box_of(all[i]));
    Group near;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Box box = box_of(all[i]);
        const bool meets = std::any_of(boxes.begin(), boxes.end(),
                                       [&box](const Box& other) { return box.meets(other); });
        if (meets) near.push_back(i);
    }
    return near;
}

class RegionTelling {
  public:
    RegionTelling(const RegionGround& ground, const RegionLimits& limits)
        : ground_(ground), allowance_(limits) {}

    core::Result<std::vector<api::RegionView>> tell() {
        std::vector<api::RegionView> views;
        if (gather()) {
            for (std::size_t i = 0; i < ground_.polygons.size(); ++i)
                if (ground_.polygons[i].is_wanted && !tell_region(i, views)) break;
        }
        if (allowance_.refused()) return *allowance_.refused();
        return views;
    }

  private:
    /// Finds the regions, and keeps of those not wanted only which triangles they have.
    bool gather() {
        const core::ConstraintHistory history(ground_.tin);
        around_.resize(ground_.tin.triangle_count(), PolygonGroups::kNone);
        regions_.resize(ground_.polygons.size());
        for (std::size_t i = 0; i < ground_.polygons.size(); ++i) {
            if (!allowance_.goes_on()) return false;
            const std::size_t groups_before = groups_.count();
            groups_.begin(i);
            const RegionGround::Drawn& polygon = ground_.polygons[i];
            if (!gather_edges(history, polygon)) return false;
            if (!polygon.has_inside) continue;
            core::Region region = core::find_region(
                ground_.tin, history,
                {polygon.shape, polygon.report.chains, polygon.report.outside}, polygon.winding);
            if (!allowance_.spend(region.triangles.size())) return false;
            for (const core::TriangleId t : region.triangles)
                around_[t.index()] = groups_.with(around_[t.index()]);
            if (!allowance_.spend_ids(groups_.count() - groups_before)) return false;
            if (polygon.is_wanted) regions_[i] = std::move(region);
        }
        return true;
    }

    bool gather_edges(const core::ConstraintHistory& history, const RegionGround::Drawn& polygon) {
        for (const core::Chain& chain : polygon.report.chains) {
            const auto edges = history.edges_along(chain.vertices);
            if (!allowance_.spend(edges.size())) return false;
            for (const auto& [a, b] : edges) {
                PolygonGroups::Id& group = along_[core::edge_key(a, b)];
                group = groups_.with(group);
            }
        }
        return true;
    }

    bool tell_region(std::size_t polygon, std::vector<api::RegionView>& views) {
        const core::Region& region = regions_[polygon];
        api::RegionView view;
        view.polygon = ground_.polygons[polygon].id;
        view.winding = ground_.polygons[polygon].winding;
        view.plan_area = region.plan_area;
        view.surface_area = region.surface_area;
        for (const core::TriangleId t : region.triangles)
            view.triangles.push_back(t.value);
        if (!tell_others(polygon, view) || !tell_edges(polygon, view)) return false;
        views.push_back(std::move(view));
        return true;
    }

    bool tell_others(std::size_t polygon, api::RegionView& view) {
        std::vector<std::pair<PolygonGroups::Id, std::uint32_t>> sorted;
        for (const core::TriangleId t : regions_[polygon].triangles)
            sorted.emplace_back(around_[t.index()], t.value);
        if (!allowance_.spend(sorted.size())) return false;
        std::sort(sorted.begin(), sorted.end());
        std::vector<std::pair<Group, std::vector<std::uint32_t>>> shared;
        Group within;
        for (std::size_t k = 0; k < sorted.size();) {
            const PolygonGroups::Id id = sorted[k].first;
            if (!allowance_.spend_ids(groups_.size(id))) return false;
            Group others = groups_.members(id);
            std::erase(others, polygon);
            Group still;
            std::set_intersection(within.begin(), within.end(), others.begin(), others.end(),
                                  std::back_inserter(still));
            within = k == 0 ? others : std::move(still);
            std::vector<std::uint32_t> slots;
            for (; k < sorted.size() && sorted[k].first == id; ++k)
                slots.push_back(sorted[k].second);
            if (!others.empty()) shared.emplace_back(std::move(others), std::move(slots));
        }
        std::sort(shared.begin(), shared.end());
        view.within = ids_of(within);
        for (auto& [others, slots] : shared)
            view.shared.push_back({ids_of(others), std::move(slots)});
        return true;
    }

    bool tell_edges(std::size_t polygon, api::RegionView& view) {
        using Ends = std::array<std::uint32_t, 2>;
        const core::Tin& tin = ground_.tin;
        std::unordered_map<PolygonGroups::Id, std::vector<Ends>> edges;
        for (const core::TriangleId t : regions_[polygon].triangles) {
            if (!allowance_.spend(1)) return false;
            for (unsigned i = 0; i < 3; ++i) {
                const core::Side side(t, i);
                if (!tin.is_constrained(side)) continue;
                const core::Side twin = tin.twin(side);
                if (twin.valid() && twin < side && contains(polygon, twin.triangle())) continue;
                const core::VertexId from = tin.origin(side), to = tin.destination(side);
                const auto along = along_.find(core::edge_key(from, to));
                edges[along == along_.end() ? PolygonGroups::kNone : along->second].push_back(
                    {from.value, to.value});
            }
        }
        std::vector<std::pair<Group, std::vector<Ends>>> told;
        for (auto& [id, pairs] : edges) {
            if (!allowance_.spend_ids(groups_.size(id))) return false;
            told.emplace_back(groups_.members(id), std::move(pairs));
        }
        std::sort(told.begin(), told.end());
        for (auto& [along, pairs] : told)
            view.edges.push_back({ids_of(along), std::move(pairs)});
        return true;
    }

    bool contains(std::size_t polygon, core::TriangleId t) const {
        const auto& triangles = regions_[polygon].triangles;
        return std::binary_search(triangles.begin(), triangles.end(), t);
    }

    std::vector<std::string> ids_of(const Group& group) const {
        std::vector<std::string> ids;
        ids.reserve(group.size());
        for (const std::size_t i : group)
            ids.push_back(ground_.polygons[i].id);
        return ids;
    }

    const RegionGround& ground_;
    RegionAllowance allowance_;
    PolygonGroups groups_;
    std::vector<PolygonGroups::Id> around_;                       ///< by triangle
    std::unordered_map<std::uint64_t, PolygonGroups::Id> along_;  ///< by `core::edge_key`
    std::vector<core::Region> regions_;  ///< one for each polygon, those not wanted empty
};

}  // namespace

std::size_t region_bytes(const core::Tin& tin, std::span<const Polygon> all) {
    constexpr std::size_t kOfAnEdge = 40;  // in the table by edges
    constexpr std::size_t kOfASplit = 24;  // in the history
    std::size_t sum = tin.triangle_count() * sizeof(PolygonGroups::Id) +
                      tin.constraint_splits().size() * (kOfASplit + kOfAnEdge);
    for (const Polygon& polygon : all) {
        sum += sizeof(RegionGround::Drawn) + held_bytes(polygon.outline()) +
               held_bytes(polygon.own_report());
        for (const core::Chain& chain : polygon.own_report().chains)
            sum += chain.vertices.size() * kOfAnEdge;
    }
    return sum;
}

RegionGround region_ground(const core::Tin& tin, std::span<const Polygon> all,
                           std::span<const std::size_t> wanted) {
    RegionGround ground{tin, {}};
    for (const std::size_t i : near_ones(all, wanted)) {
        ground.polygons.push_back({all[i].id(), all[i].has_inside(),
                                   std::binary_search(wanted.begin(), wanted.end(), i),
                                   all[i].request.winding, all[i].outline(), all[i].own_report()});
    }
    return ground;
}

core::Result<std::vector<api::RegionView>> find_regions(const RegionGround& ground,
                                                        const RegionLimits& limits) {
    return RegionTelling(ground, limits).tell();
}

}  // namespace tinsmith::server
