// SPDX-License-Identifier: Apache-2.0
#include "server/draping.hpp"

#include "core/regions/region.hpp"

namespace tinsmith::server {

namespace {

api::DrapedLine drape_chain(const core::Tin& tin, const core::ConstraintHistory& history,
                            const core::Chain& chain) {
    api::DrapedLine line{chain.path, {}};
    for (const core::VertexId v : history.expand(chain.vertices))
        line.positions.push_back(tin.vertex(v).point());
    return line;
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
        if (!chain.vertices.empty()) draped.lines.push_back(drape_chain(tin, history, chain));
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
