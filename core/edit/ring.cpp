// SPDX-License-Identifier: Apache-2.0
#include "core/edit/ring.hpp"

#include <utility>
#include <vector>

namespace tinsmith::core {

namespace {

std::vector<OutsidePart> all_outside(const Shape& shape) {
    std::vector<OutsidePart> parts;
    for (std::size_t i = 0; i < shape.paths.size(); ++i) {
        if (shape.paths[i].points.empty()) continue;
        parts.push_back({i, shape.paths[i].points});
        parts.back().points.push_back(shape.paths[i].points.front());
    }
    return parts;
}

}  // namespace

Result<Report> integrate_ring(Tin& tin, const Shape& shape, const IntegrateOptions& options,
                              Undo* undo) {
    auto report = integrate(tin, {&shape, 1}, options, undo);
    if (report || report.errors().front().code != ErrorCode::OutsideMesh) return report;
    Report nothing;
    nothing.shapes.emplace_back();
    nothing.shapes.back().outside = all_outside(shape);
    return nothing;
}

}  // namespace tinsmith::core
