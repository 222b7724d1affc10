// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/integrator.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "core/integrate/improve.hpp"
#include "core/integrate/march.hpp"
#include "core/integrate/measure.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

/// Adds the time since the last lap to one stage or another; all laps together are the whole.
class Stopwatch {
  public:
    explicit Stopwatch(const std::function<double()>& clock) : clock_(clock) {
        if (clock_) last_ = clock_();
    }
    void lap(double& stage) {
        if (!clock_) return;
        const double now = clock_();
        stage += now - last_;
        last_ = now;
    }

  private:
    const std::function<double()>& clock_;
    double last_ = 0.0;
};

Errors check_shapes(std::span<const Shape> shapes) {
    Errors errors;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        for (std::size_t p = 0; p < shapes[s].paths.size(); ++p) {
            const auto& points = shapes[s].paths[p].points;
            for (std::size_t i = 0; i < points.size() && errors.size() < kMaxFaults; ++i) {
                const bool finite = std::isfinite(points[i].x) && std::isfinite(points[i].y);
                if (finite && in_coordinate_range(points[i].x) && in_coordinate_range(points[i].y))
                    continue;
                ErrorPlace place;
                place.shape = s;
                place.path = p;
                place.point = i;
                if (finite) place.position = points[i];
                errors.push_back(
                    {finite ? ErrorCode::CoordinateOutOfRange : ErrorCode::CoordinateNotFinite,
                     "a coordinate is not finite or out of range", place});
            }
        }
    }
    return errors;
}

/// Integrates one shape; the surgery is committed by the caller.
class ShapeIntegration {
  public:
    ShapeIntegration(Surgery& surgery, const IntegrateOptions& options, Stopwatch& watch,
                     StageTimes& times, const MarchLimits& limits)
        : surgery_(surgery),
          options_(options),
          watch_(watch),
          times_(times),
          march_(surgery, options, limits),
          improver_(surgery) {}

    /// False: see `march().error()`.
    bool run(const Shape& shape) {
        for (std::size_t p = 0; p < shape.paths.size(); ++p) {
            if (shape.paths[p].points.empty()) continue;
            if (run(p, shape.paths[p])) continue;
            return false;
        }
        improve(0);
        return true;
    }

    March& march() { return march_; }

    ShapeReport report() const {
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
        const Measurement measured = measure_operation(tin, record);
        report.smallest_angle_deg = measured.smallest_angle_deg;
        if (report.vertices_added > 0 || report.edges_swapped > 0)
            report.max_vertical_deviation = rounding_bound(tin, measured.steepest_slope);
        return report;
    }

  private:
    bool run(std::size_t index, const Path& path) {
        if (!march_.begin(index, path)) return false;
        watch_.lap(times_.locate);
        Point2 last = path.points.front();
        const std::size_t count = path.points.size();
        for (std::size_t i = 1; i < count + (path.closed ? 1 : 0); ++i) {
            const Point2 next = path.points[i % count];
            if (next == last) continue;
            if (!march_.advance(i % count)) {
                march_.error()->place.point = i - 1;
                return false;
            }
            last = next;
            improve(kImproveBatch);
        }
        const bool done = march_.finish();
        watch_.lap(times_.integrate);
        return done;
    }

    /// Improves once so many vertices wait: often enough that facets stay in good shape for the
    /// march and in the cache, seldom enough that the clock costs nothing.
    void improve(std::size_t waiting) {
        std::vector<VertexId>& changed = march_.changed();
        if (changed.empty() || changed.size() < waiting) return;
        if (options_.improve == Improve::Strict) {
            watch_.lap(times_.integrate);
            improver_.improve(changed);
            watch_.lap(times_.improve);
        }
        changed.clear();
    }

    /// New vertices are off the old surface's edges by at most `4 ulp` in plan, which the slope
    /// turns into height, and elevations are interpolated to a few ulps of their own.
    static double rounding_bound(const Tin& tin, double slope) {
        const Bounds& box = tin.bounds();
        const double plan = std::max({std::fabs(box.min.x), std::fabs(box.max.x),
                                      std::fabs(box.min.y), std::fabs(box.max.y)});
        const double height = std::max(std::fabs(box.min.z), std::fabs(box.max.z));
        return 4.0 * ulp(plan) * slope + 8.0 * ulp(height);
    }

    static constexpr std::size_t kImproveBatch = 64;

    Surgery& surgery_;
    const IntegrateOptions& options_;
    Stopwatch& watch_;
    StageTimes& times_;
    March march_;
    Improver improver_;
};

/// Whether the position lies inside the shape's closed paths, by even-odd.
bool encloses(const Shape& shape, Point2 p) {
    bool inside = false;
    for (const Path& path : shape.paths) {
        if (!path.closed) continue;
        for (std::size_t i = 0; i < path.points.size(); ++i) {
            const Point2 a = path.points[i];
            const Point2 b = path.points[(i + 1) % path.points.size()];
            if ((a.y > p.y) == (b.y > p.y)) continue;
            if (is_left(a, b, p) == (b.y > a.y)) inside = !inside;
        }
    }
    return inside;
}

/// Whether any of the mesh lies inside the shapes. Requires: no path meets the mesh, so that each
/// component is inside or outside as a whole.
bool encloses_mesh(const Tin& tin, std::span<const Shape> shapes) {
    const std::vector<TriangleId>& components = tin.components();
    return std::any_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
        return std::any_of(components.begin(), components.end(), [&](TriangleId t) {
            return encloses(shape, tin.plan(tin.triangle(t).vertices[0]));
        });
    });
}

std::string millimetres(double value) {
    char text[400];  // the largest double has 309 digits before the point
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 3).ptr};
}

std::string describe(Point2 low, Point2 high) {
    return "x " + millimetres(low.x) + " to " + millimetres(high.x) + ", y " + millimetres(low.y) +
           " to " + millimetres(high.y);
}

Error outside_error(const Tin& tin, std::span<const Shape> shapes) {
    Error error{ErrorCode::OutsideMesh, {}, {}};
    std::optional<Point2> low, high;
    for (const Shape& shape : shapes) {
        for (const Path& path : shape.paths) {
            for (const Point2 p : path.points) {
                low = low ? Point2{std::min(low->x, p.x), std::min(low->y, p.y)} : p;
                high = high ? Point2{std::max(high->x, p.x), std::max(high->y, p.y)} : p;
            }
        }
    }
    if (!low) {
        error.code = ErrorCode::ShapeEmpty;
        error.detail = "the request has no position; give at least one";
        return error;
    }
    error.detail = "nothing of the request meets the mesh: the request spans " +
                   describe(*low, *high) + ", the mesh " +
                   describe(tin.bounds().min.plan(), tin.bounds().max.plan());
    error.place.position = shapes[0].paths.empty() || shapes[0].paths[0].points.empty()
                               ? *low
                               : shapes[0].paths[0].points[0];
    const Bounds& box = tin.bounds();
    const bool like_degrees =
        low->x >= -180.0 && high->x <= 180.0 && low->y >= -90.0 && high->y <= 90.0;
    const bool mesh_is_far =
        box.min.x > 180.0 || box.max.x < -180.0 || box.min.y > 90.0 || box.max.y < -90.0;
    if (like_degrees && mesh_is_far)
        error.detail += "; its coordinates look like degrees of longitude and latitude";
    return error;
}

Errors leaving_errors(const Report& report) {
    Errors errors;
    for (std::size_t s = 0; s < report.shapes.size(); ++s) {
        for (const OutsidePart& part : report.shapes[s].outside) {
            if (errors.size() == kMaxFaults) return errors;
            ErrorPlace place;
            place.shape = s;
            place.path = part.path;
            place.position = part.points.front();
            errors.push_back({ErrorCode::LeavesMesh,
                              "the path is outside the mesh from here to x " +
                                  millimetres(part.points.back().x) + ", y " +
                                  millimetres(part.points.back().y) +
                                  "; cut it at the mesh, or ask to skip what is outside",
                              place});
        }
    }
    return errors;
}

}  // namespace

Result<Report> integrate(Tin& tin, std::span<const Shape> shapes, const IntegrateOptions& options,
                         Undo* undo) {
    if (Errors errors = check_shapes(shapes); !errors.empty()) return errors;
    Report report;
    Stopwatch watch(options.clock_ms);
    Undo done;
    bool met_mesh = false;
    // The budgets are the request's: each shape leaves the rest of them to the next.
    MarchLimits limits{options.max_crossings, options.max_new_triangles, &options.cancelled};
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        Surgery surgery(tin);
        ShapeIntegration integration(surgery, options, watch, report.time_ms, limits);
        if (!integration.run(shapes[s])) {
            Error error = *integration.march().error();
            error.place.shape = s;
            surgery.roll_back();
            take_back(tin, done);
            return error;
        }
        const MarchTally& tally = integration.march().tally();
        met_mesh = met_mesh || tally.met_mesh;
        limits.max_crossings -= tally.crossings + tally.self_crossings;
        limits.max_new_triangles -= tin.triangle_count() - surgery.record().triangle_count;
        report.shapes.push_back(integration.report());
        done.push_back(surgery.commit());
        watch.lap(report.time_ms.integrate);
    }
    const bool leaves = std::any_of(report.shapes.begin(), report.shapes.end(),
                                    [](const ShapeReport& r) { return !r.outside.empty(); });
    if (!met_mesh && !encloses_mesh(tin, shapes)) {
        take_back(tin, done);
        return outside_error(tin, shapes);
    }
    if (leaves && options.outside == Outside::Reject) {
        take_back(tin, done);
        return leaving_errors(report);
    }
    if (undo != nullptr) *undo = std::move(done);
    watch.lap(report.time_ms.integrate);
    return report;
}

void take_back(Tin& tin, const Undo& undo) {
    for (auto record = undo.rbegin(); record != undo.rend(); ++record)
        Surgery::undo(tin, *record);
}

}  // namespace tinsmith::core
