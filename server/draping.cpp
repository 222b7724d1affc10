// SPDX-License-Identifier: Apache-2.0
#include "server/draping.hpp"

#include "core/regions/region.hpp"

namespace tinsmith::server {

namespace {

/// Adds the parts of the chain that the mesh holds. False: a removal took some of it.
bool drape_chain(const core::Tin& tin, const core::ConstraintHistory& history,
                 const core::Chain& chain, std::vector<api::DrapedLine>& lines) {
    const std::size_t before = lines.size();
    core::VertexId first, last;  // by name: where the mesh was parted at a vertex, the line goes on
    for (const auto& part : history.lines_along(chain.vertices)) {
        const bool goes_on = lines.size() > before && tin.name(part.front()) == last;
        if (!goes_on) lines.push_back({chain.path, {}});
        if (!first.valid()) first = tin.name(part.front());
        last = tin.name(part.back());
        for (std::size_t i = goes_on ? 1 : 0; i < part.size(); ++i)
            lines.back().positions.push_back(tin.vertex(part[i]).point());
    }
    return lines.size() == before + 1 && first == chain.vertices.front() &&
           last == chain.vertices.back();
}

}  // namespace

api::DrapedPolygon drape(const core::Tin& tin, const core::ConstraintHistory& history,
                         const Polygon& polygon) {
    const core::ShapeReport& report = polygon.own_report();
    api::DrapedPolygon draped;
    draped.id = polygon.id();
    draped.client_id = polygon.origin().client_id;
    draped.properties = polygon.origin().properties;
    draped.type = polygon.origin().type;
    draped.paths = polygon.origin().paths;
    draped.polygon_starts = polygon.origin().polygon_starts;
    draped.partly_outside = !report.outside.empty();
    for (const core::Chain& chain : report.chains) {
        if (chain.vertices.empty()) continue;
        const bool is_whole = drape_chain(tin, history, chain, draped.lines);
        draped.partly_outside = draped.partly_outside || !is_whole;
    }
    if (polygon.has_inside()) {
        const core::Region region =
            core::find_region(tin, history, {polygon.outline(), report.chains, report.outside},
                              polygon.request.winding);
        draped.region = {polygon.request.winding, region.plan_area, region.surface_area,
                         region.triangles.size()};
    }
    return draped;
}

}  // namespace tinsmith::server
