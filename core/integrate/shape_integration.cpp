// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/shape_integration.hpp"

#include <algorithm>
#include <cmath>

#include "core/integrate/measure.hpp"
#include "core/mesh/walk.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

/// Rounding of one interpolated elevation, in ulps of the largest.
constexpr double kInterpolationUlps = 4.0;

}  // namespace

bool ShapeIntegration::run(const Shape& shape, std::size_t index, const Ways& ways) {
    std::size_t points = 0;
    for (const Path& path : shape.paths)
        points += path.points.size();
    constexpr std::size_t kMost = 1U << 16;  // what is longer may grow as it comes
    surgery_.expect(std::min(points, kMost));
    drift_.expect(std::min(points, kMost));
    for (std::size_t p = 0; p < shape.paths.size(); ++p) {
        if (shape.paths[p].points.empty()) continue;
        const Way& way = ways.of(index, p);
        if (!(way.is_reversed ? run_reversed(p, shape.paths[p], way) : run(p, shape.paths[p], way)))
            return false;
    }
    improve(0);
    return set_elevations();
}

/// Marches the path from its end and turns what the march says of it round again.
bool ShapeIntegration::run_reversed(std::size_t index, const Path& path, const Way& way) {
    Path turned = path;
    const auto turn = [&path](auto& list) {
        // A ring still begins at its first point.
        std::reverse(list.begin() + (path.closed && !list.empty() ? 1 : 0), list.end());
    };
    turn(turned.points);
    turn(turned.elevations);
    MarchTally& tally = march_.tally();
    const std::size_t chains = tally.chains.size(), outside = tally.outside.size();
    if (!run(index, turned, way)) {
        // From segment i of the turned path to that of the path.
        const std::size_t last = path.points.size() - (path.closed ? 1 : 2);
        if (auto& point = march_.error()->place.point) point = last - std::min(last, *point);
        return false;
    }
    std::reverse(tally.chains.begin() + static_cast<std::ptrdiff_t>(chains), tally.chains.end());
    for (std::size_t i = chains; i < tally.chains.size(); ++i)
        std::reverse(tally.chains[i].vertices.begin(), tally.chains[i].vertices.end());
    std::reverse(tally.outside.begin() + static_cast<std::ptrdiff_t>(outside), tally.outside.end());
    for (std::size_t i = outside; i < tally.outside.size(); ++i)
        std::reverse(tally.outside[i].points.begin(), tally.outside[i].points.end());
    return true;
}

bool ShapeIntegration::run(std::size_t index, const Path& path, const Way& way) {
    if (!march_.begin(index, path, way)) return false;
    watch_.lap(times_.locate);
    Point2 last = path.points.front();
    const std::size_t count = path.points.size();
    constexpr std::size_t kImproveBatch = 64;
    for (std::size_t i = 1; i < count + (path.closed ? 1 : 0); ++i) {
        const Point2 next = path.points[i % count];
        if (next == last) continue;
        if (!march_.advance(i % count)) {
            march_.error()->place.point = i - 1;
            return false;
        }
        last = next;
        progress_.end_segment();
        improve(kImproveBatch);
    }
    const bool done = march_.finish();
    watch_.lap(times_.integrate);
    return done;
}

/// Improves once so many vertices wait: often enough that facets stay in good shape for the march
/// and in the cache, seldom enough that the clock costs nothing. Swaps across facets wait until all
/// the request is in the mesh.
void ShapeIntegration::improve(std::size_t waiting) {
    if (!march_.has_changed(std::max<std::size_t>(waiting, 1))) return;
    std::vector<VertexId>& changed = march_.changed();
    if (options_.improve != Improve::None) {
        watch_.lap(times_.integrate);
        improver_.improve(changed);
        watch_.lap(times_.improve);
    }
    if (options_.improve == Improve::Paper || options_.improve == Improve::Bounded)
        changed_.insert(changed_.end(), changed.begin(), changed.end());
    changed.clear();
}

/// Gives the chain the elevations that its paths bring; the last word on a vertex holds. The
/// triangles there are no longer known to lie in one plane with any neighbour: each gets a facet of
/// its own.
bool ShapeIntegration::set_elevations() {
    std::vector<OwnElevation> own = march_.own_elevations();
    std::stable_sort(own.begin(), own.end(), [](const OwnElevation& l, const OwnElevation& r) {
        return l.vertex < r.vertex;
    });
    const Tin& tin = surgery_.tin();
    const std::uint32_t first_fresh = tin.next_facet();
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (i + 1 < own.size() && own[i + 1].vertex == own[i].vertex) continue;
        const double change = std::fabs(own[i].z - tin.vertex(own[i].vertex).z);
        if (change == 0.0) continue;
        max_elevation_change_ = std::max(max_elevation_change_, change);
        set_vertices_.push_back(own[i].vertex);
        surgery_.set_elevation(own[i].vertex, own[i].z);
        bool has_facets = true;
        for_each_side_at(tin, own[i].vertex, [&](Side side) {
            for (const Side s : {side, tin.twin(side)}) {
                if (!s.valid() || tin.facet(s.triangle()).value >= first_fresh) continue;
                has_facets = has_facets && tin.next_facet() < options_.ids.facets;
                if (has_facets) surgery_.give_fresh_facet(s.triangle());
            }
        });
        if (!has_facets) {
            march_.error() = Error{ErrorCode::IdBudget, kNoFacetLeft, {}};
            return false;
        }
    }
    return true;
}

ShapeReport ShapeIntegration::report() {
    const MarchTally& tally = march_.tally();
    const UndoRecord& record = surgery_.record();
    const Tin& tin = surgery_.tin();
    ShapeReport report;
    report.segments = tally.segments;
    report.crossings = tally.crossings;
    report.vertices_added = tin.vertex_count() - record.vertex_count;
    report.triangles_added = tin.triangle_count() - record.triangle_count;
    report.edges_swapped = tally.edges_swapped + improver_.edges_swapped();
    report.outside = tally.outside;
    report.chains = tally.chains;
    report.max_plan_deviation = tally.max_plan_deviation;
    report.max_elevation_change = max_elevation_change_;
    const Measurement measured = measure_operation(tin, {record, tin.triangle_count()});
    report.smallest_angle_deg = measured.smallest_angle_deg;
    if (report.vertices_added > 0 || report.edges_swapped > 0)
        report.max_vertical_deviation = certify(measured);
    return report;
}

/// A bound on how far rounding moved the surface. A vertex put on an edge between facets is off it
/// by a `bend` in plan, hence off either facet's plane by that times the slopes of both, and its
/// elevation is rounded, once more each time that it is interpolated from vertices of the same
/// request. Facets that had several triangles before were off their planes already:
/// the surface there may move by what it was off and what it is.
double ShapeIntegration::certify(const Measurement& measured) {
    const Tin& tin = surgery_.tin();
    const Bounds& box = tin.bounds();
    const double height = std::max(std::fabs(box.min.z), std::fabs(box.max.z));
    const double added = 2.0 * measured.steepest_slope * drift_.largest_bend() +
                         kInterpolationUlps * (1.0 + drift_.deepest()) * ulp(height);
    const double before = measured.met_divided_facets ? tin.facet_error() : 0.0;
    surgery_.raise_facet_error(before + added);
    return before + (before + added);
}

}  // namespace tinsmith::core
