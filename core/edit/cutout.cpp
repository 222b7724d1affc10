// SPDX-License-Identifier: Apache-2.0
#include "core/edit/cutout.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/edit/ring.hpp"
#include "core/mesh/build.hpp"

namespace tinsmith::core {

namespace {

/// The closed paths, without elevations of their own.
Shape outline_of(const Shape& shape) {
    Shape outline;
    for (const Path& path : shape.paths) {
        if (path.closed) outline.paths.push_back({path.points, true, {}});
    }
    return outline;
}

Result<Region> cut_in(Tin& tin, const Shape& shape, Winding winding, const CutoutLimits& limits) {
    IntegrateOptions options;
    options.improve = Improve::None;
    options.max_crossings = limits.max_crossings;
    options.max_new_triangles = limits.max_new_triangles;
    options.cancelled = limits.cancelled;
    options.progress = limits.progress;
    auto report = integrate_ring(tin, shape, options);
    if (!report) return std::move(report.errors());
    const ShapeReport& found = report->shapes.front();
    return find_region(tin, ConstraintHistory(tin), {shape, found.chains, found.outside}, winding);
}

/// Two triangles around all positions of the shape, level. Nothing where it has no extent.
Result<Tin> frame_around(const Shape& shape) {
    MeshData frame;
    if (shape.paths.empty() || shape.paths.front().points.empty()) return build_tin(frame);
    Point2 low = shape.paths.front().points.front(), high = low;
    for (const Path& path : shape.paths) {
        for (const Point2& p : path.points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }
    const double width = high.x - low.x, height = high.y - low.y;
    low = {low.x - width, low.y - height};
    high = {high.x + width, high.y + height};
    frame.vertices = {
        {low.x, low.y, 0.0}, {high.x, low.y, 0.0}, {high.x, high.y, 0.0}, {low.x, high.y, 0.0}};
    frame.triangles = {{0, 1, 2}, {0, 2, 3}};
    return build_tin(frame);
}

}  // namespace

Result<Cutout> cut_out(Tin tin, const Shape& shape, Winding winding, const CutoutLimits& limits) {
    const Shape outline = outline_of(shape);
    auto region = cut_in(tin, outline, winding, limits);
    if (!region) return std::move(region.errors());
    auto area = area_inside(outline, winding, limits);
    if (!area) return std::move(area.errors());
    return Cutout{std::move(tin), std::move(*region), *area};
}

Result<double> area_inside(const Shape& shape, Winding winding, const CutoutLimits& limits) {
    const Shape outline = outline_of(shape);
    auto frame = frame_around(outline);
    if (!frame) return 0.0;
    auto whole = cut_in(*frame, outline, winding, limits);
    if (!whole) return std::move(whole.errors());
    return whole->plan_area;
}

Result<std::vector<Triangle2>> triangles_inside(const Shape& shape, Winding winding,
                                                const CutoutLimits& limits) {
    const Shape outline = outline_of(shape);
    auto frame = frame_around(outline);
    if (!frame) return std::vector<Triangle2>{};
    auto whole = cut_in(*frame, outline, winding, limits);
    if (!whole) return std::move(whole.errors());
    std::vector<Triangle2> triangles;
    triangles.reserve(whole->triangles.size());
    for (const TriangleId t : whole->triangles) {
        const auto& [a, b, c] = frame->triangle(t).vertices;
        triangles.push_back({frame->plan(a), frame->plan(b), frame->plan(c)});
    }
    return triangles;
}

}  // namespace tinsmith::core
