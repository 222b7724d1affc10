// SPDX-License-Identifier: Apache-2.0
#include "server/regions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/regions/constraint_history.hpp"
#include "core/regions/coverage.hpp"

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
    RegionTelling(const core::Tin& tin, std::span<const Polygon> all, const Group& near)
        : tin_(tin), all_(all), regions_(all.size()) {
        const core::ConstraintHistory history(tin);
        std::vector<core::Coverage::Area> areas;
        std::vector<core::Linework::Lines> lines;
        for (const std::size_t i : near) {
            const core::ShapeReport& report = all[i].own_report();
            lines.push_back({i, report.chains});
            if (!all[i].has_inside()) continue;
            regions_[i] =
                core::find_region(tin, history, {all[i].outline(), report.chains, report.outside},
                                  all[i].request.winding);
            areas.push_back({i, &regions_[i]});
        }
        coverage_ = core::Coverage(areas);
        linework_ = core::Linework(history, lines);
    }

    api::RegionView tell(std::size_t polygon) const {
        const core::Region& region = regions_[polygon];
        api::RegionView view;
        view.polygon = all_[polygon].id();
        view.winding = all_[polygon].request.winding;
        view.plan_area = region.plan_area;
        view.surface_area = region.surface_area;
        for (const core::TriangleId t : region.triangles)
            view.triangles.push_back(t.value);
        tell_others(polygon, view);
        tell_edges(polygon, view);
        return view;
    }

  private:
    void tell_others(std::size_t polygon, api::RegionView& view) const {
        const std::vector<core::TriangleId>& triangles = regions_[polygon].triangles;
        std::map<Group, std::vector<std::uint32_t>> shared;
        Group within;
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            const auto around = coverage_.containing(triangles[k]);
            Group others(around.begin(), around.end());
            std::erase(others, polygon);
            Group still;
            std::set_intersection(within.begin(), within.end(), others.begin(), others.end(),
                                  std::back_inserter(still));
            within = k == 0 ? others : std::move(still);
            if (!others.empty()) shared[std::move(others)].push_back(triangles[k].value);
        }
        view.within = ids_of(within);
        for (auto& [others, slots] : shared)
            view.shared.push_back({ids_of(others), std::move(slots)});
    }

    void tell_edges(std::size_t polygon, api::RegionView& view) const {
        std::map<Group, std::vector<std::array<std::uint32_t, 2>>> edges;
        for (const core::TriangleId t : regions_[polygon].triangles) {
            for (unsigned i = 0; i < 3; ++i) {
                const core::Side side(t, i);
                if (!tin_.is_constrained(side)) continue;
                const core::Side twin = tin_.twin(side);
                if (twin.valid() && twin < side && contains(polygon, twin.triangle())) continue;
                const auto along = linework_.along(tin_, side);
                edges[Group(along.begin(), along.end())].push_back(
                    {tin_.origin(side).value, tin_.destination(side).value});
            }
        }
        for (auto& [along, pairs] : edges)
            view.edges.push_back({ids_of(along), std::move(pairs)});
    }

    bool contains(std::size_t polygon, core::TriangleId t) const {
        const auto around = coverage_.containing(t);
        return std::binary_search(around.begin(), around.end(), polygon);
    }

    std::vector<std::string> ids_of(const Group& group) const {
        std::vector<std::string> ids;
        for (const std::size_t i : group)
            ids.push_back(all_[i].id());
        return ids;
    }

    const core::Tin& tin_;
    std::span<const Polygon> all_;
    std::vector<core::Region> regions_;  ///< one for each polygon, those far away empty
    core::Coverage coverage_{{}};
    core::Linework linework_{core::ConstraintHistory(tin_), {}};
};

}  // namespace

std::vector<api::RegionView> find_regions(const core::Tin& tin, std::span<const Polygon> all,
                                          std::span<const std::size_t> wanted) {
    const RegionTelling telling(tin, all, near_ones(all, wanted));
    std::vector<api::RegionView> views;
    for (const std::size_t i : wanted)
        views.push_back(telling.tell(i));
    return views;
}

}  // namespace tinsmith::server
