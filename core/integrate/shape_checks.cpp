// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/shape_checks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

/// What is wrong with one point of a path, if anything.
std::optional<Error> check_point(const Path& path, std::size_t i) {
    const Point2 p = path.points[i];
    const auto fault = [&](double value) -> std::optional<Error> {
        if (!std::isfinite(value))
            return Error{ErrorCode::CoordinateNotFinite, "a coordinate is not finite", {}};
        if (!in_coordinate_range(value))
            return Error{ErrorCode::CoordinateOutOfRange, "a coordinate is out of range", {}};
        return std::nullopt;
    };
    for (const double value : {p.x, p.y})
        if (auto error = fault(value)) return error;
    if (path.elevations.empty()) return std::nullopt;
    if (i >= path.elevations.size())
        return Error{ErrorCode::ElevationMissing, "the point has no elevation; give it one", {}};
    if (auto error = fault(path.elevations[i])) return error;
    const std::size_t previous = i > 0 ? i - 1 : path.points.size() - 1;
    if ((i == 0 && !path.closed) || previous >= path.elevations.size()) return std::nullopt;
    if (p == path.points[previous] && path.elevations[i] != path.elevations[previous])
        return Error{ErrorCode::ElevationTwice,
                     "the point and the one before it are one position with two elevations; a "
                     "terrain has one: drop either",
                     {}};
    return std::nullopt;
}

/// Whether nothing is wrong with a path that brings no elevations. Not finite is not in range.
bool is_plainly_right(const Path& path) {
    return path.elevations.empty() &&
           std::all_of(path.points.begin(), path.points.end(), [](Point2 p) {
               return in_coordinate_range(p.x) && in_coordinate_range(p.y);
           });
}

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

std::string millimetres(double value) {
    char text[400];  // the largest double has 309 digits before the point
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 3).ptr};
}

std::string describe(Point2 low, Point2 high) {
    return "x " + millimetres(low.x) + " to " + millimetres(high.x) + ", y " + millimetres(low.y) +
           " to " + millimetres(high.y);
}

}  // namespace

Errors check_shapes(std::span<const Shape> shapes) {
    Errors errors;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        for (std::size_t p = 0; p < shapes[s].paths.size(); ++p) {
            const Path& path = shapes[s].paths[p];
            if (is_plainly_right(path)) continue;
            for (std::size_t i = 0; i < path.points.size() && errors.size() < kMaxFaults; ++i) {
                std::optional<Error> error = check_point(path, i);
                if (!error) continue;
                error->place.shape = s;
                error->place.path = p;
                error->place.point = i;
                const Point2 at = path.points[i];
                if (std::isfinite(at.x) && std::isfinite(at.y)) error->place.position = at;
                errors.push_back(std::move(*error));
            }
        }
    }
    return errors;
}

bool encloses_mesh(const Tin& tin, std::span<const Shape> shapes) {
    const std::vector<TriangleId>& components = tin.components();
    return std::any_of(shapes.begin(), shapes.end(), [&](const Shape& shape) {
        return std::any_of(components.begin(), components.end(), [&](TriangleId t) {
            return encloses(shape, tin.plan(tin.triangle(t).vertices[0]));
        });
    });
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
        error.detail +=
            "; its coordinates look like degrees of longitude and latitude: if they are, "
            "name their system with the option crs";
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

}  // namespace tinsmith::core
