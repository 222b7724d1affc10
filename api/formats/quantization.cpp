// SPDX-License-Identifier: Apache-2.0
#include "api/formats/quantization.hpp"

#include <algorithm>
#include <cmath>

#include "api/parts.hpp"

namespace tinsmith::api {
namespace {

/// Room for the rounding of x * unit and of the subtraction of the origin, relative to half a step.
constexpr double kRoom = 1.0 - 0x1p-40;

std::array<double, 3> in_metres(const core::Point3& vertex, double unit) {
    return {vertex.x * unit, vertex.y * unit, vertex.z * unit};
}

double widest_half(const Box<double>& bounds, const std::array<double, 3>& middle) {
    double half = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        half = std::max({half, bounds.high[axis] - middle[axis], middle[axis] - bounds.low[axis]});
    }
    return half;
}

/// Is the mesh within kGridLimit steps of 2^exponent metres from its middle?
bool holds(const Box<double>& bounds, const std::array<double, 3>& middle, int exponent) {
    return std::ldexp(widest_half(bounds, middle), -exponent) < double{kGridLimit} - 1.0;
}

/// Finds the nearest points of one grid.
class Rounding {
  public:
    Rounding(double unit, const PositionGrid& grid)
        : unit_(unit), origin_(grid.origin), steps_in_metre_(std::ldexp(1.0, -grid.exponent)) {}

    GridPoint operator()(const core::Point3& vertex) const {
        const std::array<double, 3> metres = in_metres(vertex, unit_);
        GridPoint point{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // A double this large has no room for a fraction: the sum is rounded to a whole number,
            // a tie to the even one, on every machine, and three times as fast as by lrint.
            const double rounded = (metres[axis] - origin_[axis]) * steps_in_metre_ + kWhole;
            point[axis] = static_cast<std::int32_t>(rounded - kWhole);
        }
        return point;
    }

  private:
    static constexpr double kWhole = 0x1.8p52;

    double unit_;
    std::array<double, 3> origin_;
    double steps_in_metre_;
};

/// What the points are off by in metres; `points` are of the vertices.
std::array<double, 3> largest_error(std::span<const core::Point3> vertices, double unit,
                                    const PositionGrid& grid, const GridPoint* points) {
    const double step = grid.step();
    std::array<double, 3> largest{};
    for (const core::Point3& vertex : vertices) {
        const std::array<double, 3> metres = in_metres(vertex, unit);
        const GridPoint& point = *points++;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double decoded = grid.origin[axis] + step * point[axis];
            largest[axis] = std::max(largest[axis], std::fabs(decoded - metres[axis]));
        }
    }
    return largest;
}

PlanCheck check_alone(std::span<const GridPoint> points,
                      std::span<const std::array<std::uint32_t, 3>> triangles) {
    PlanCheck check;
    for (const auto& [a, b, c] : triangles) {
        const std::int64_t ax = points[a][0];
        const std::int64_t ay = points[a][1];
        // Differences stay within 2^31, so each product fits; they are compared, not subtracted.
        const std::int64_t left = (points[b][0] - ax) * (points[c][1] - ay);
        const std::int64_t right = (points[b][1] - ay) * (points[c][0] - ax);
        if (left < right) ++check.flipped;
        if (left == right) ++check.collapsed;
    }
    return check;
}

/// The triangles that are flipped or collapsed.
std::vector<std::array<std::uint32_t, 3>> faulty(
    std::span<const GridPoint> points, std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::vector<std::array<std::uint32_t, 3>> found;
    for (const auto& corners : triangles) {
        if (check_alone(points, {&corners, 1}).faults() > 0) found.push_back(corners);
    }
    return found;
}

/// Seven numbers that no memory holds while they grow. Comparisons pass over what is not a number;
/// what is not finite less itself is none, and so is the sum.
Box<double> box_of(std::span<const core::Point3> vertices) {
    core::Point3 low{vertices[0]}, high{vertices[0]};
    double zero = 0.0;
    for (const core::Point3& v : vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        zero += (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
    }
    return {{low.x + zero, low.y + zero, low.z + zero},
            {high.x + zero, high.y + zero, high.z + zero}};
}

}  // namespace

double PositionGrid::step() const {
    return std::ldexp(1.0, exponent);
}

std::int32_t PositionGrid::period() const {
    return exponent >= 0 ? 1 : std::int32_t{1} << -exponent;
}

Box<double> bounds_of(const core::MeshData& mesh, const core::Executor& executor) {
    Box<double> bounds;
    if (mesh.vertices.empty()) return bounds;
    std::array<Box<double>, kMostParts> boxes;
    in_parts(executor, mesh.vertices.size(), [&](Part part) {
        boxes[part.number] =
            box_of(std::span(mesh.vertices).subspan(part.begin, part.end - part.begin));
    });
    for (const Box<double>& box : boxes) {
        if (!(box.low[0] == box.low[0])) return box;
        bounds.add(box);
    }
    return bounds;
}

Box<double> in_metres(Box<double> bounds, double unit_to_metre) {
    // Rounding keeps the order: the least coordinate is the least in metres as well.
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.low[axis] *= unit_to_metre;
        bounds.high[axis] *= unit_to_metre;
    }
    return bounds;
}

std::array<double, 3> whole_metre_middle(const Box<double>& bounds) {
    std::array<double, 3> middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Adding zero turns a rounded -0.4 into a plain 0 for the JSON.
        middle[axis] = std::nearbyint(bounds.low[axis] / 2 + bounds.high[axis] / 2) + 0.0;
    }
    return middle;
}

std::optional<PositionGrid> grid_for(const Box<double>& bounds, double tolerance) {
    // Rounding to a step s moves a coordinate by s / 2 at most: s is the power of two <= 2 * t.
    int exponent = 0;
    std::frexp(std::min(tolerance, 0x1p40) * kRoom, &exponent);  // t = f * 2^exponent, f < 1
    PositionGrid grid{whole_metre_middle(bounds), std::min(exponent, kCoarsestExponent)};
    if (grid.exponent < kFinestExponent) return std::nullopt;
    if (!holds(bounds, grid.origin, grid.exponent)) return std::nullopt;
    return grid;
}

double finest_tolerance(const Box<double>& bounds) {
    const std::array<double, 3> middle = whole_metre_middle(bounds);
    int exponent = kFinestExponent;
    // Ends: doubles reach 2^1024.
    while (!holds(bounds, middle, exponent))
        ++exponent;
    return std::ldexp(1.0, exponent);
}

GridVertices quantize(const core::MeshData& mesh, double unit_to_metre, const PositionGrid& grid,
                      const core::Executor& executor) {
    const Rounding nearest(unit_to_metre, grid);
    GridVertices made;
    made.points.resize(mesh.vertices.size());
    std::array<std::array<double, 3>, kMostParts> errors{};
    in_parts(executor, made.points.size(), [&](Part part) {
        const auto vertices = std::span(mesh.vertices).subspan(part.begin, part.end - part.begin);
        GridPoint* const points = made.points.data() + part.begin;
        std::ranges::transform(vertices, points, nearest);
        errors[part.number] = largest_error(vertices, unit_to_metre, grid, points);
    });
    for (const std::array<double, 3>& error : errors) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            made.axis_error[axis] = std::max(made.axis_error[axis], error[axis]);
    }
    return made;
}

PlanCheck check_plan(std::span<const GridPoint> points,
                     std::span<const std::array<std::uint32_t, 3>> triangles,
                     const core::Executor& executor) {
    std::array<PlanCheck, kMostParts> checks;
    in_parts(executor, triangles.size(), [&](Part part) {
        checks[part.number] =
            check_alone(points, triangles.subspan(part.begin, part.end - part.begin));
    });
    PlanCheck all;
    for (const PlanCheck& check : checks)
        all.add(check);
    return all;
}

GridPositions best_positions(const core::MeshData& mesh, double unit_to_metre,
                             const PositionGrid& coarsest, std::int32_t span,
                             const core::Executor& executor) {
    const auto at = [&](const PositionGrid& grid) {
        GridPositions made{grid, quantize(mesh, unit_to_metre, grid, executor), {}};
        made.check = check_plan(made.vertices.points, mesh.triangles, executor);
        return made;
    };
    GridPositions best = at(coarsest);
    if (best.check.faults() == 0) return best;
    const double half =
        widest_half(in_metres(bounds_of(mesh, executor), unit_to_metre), coarsest.origin);
    const auto suspects = faulty(best.vertices.points, mesh.triangles);
    PositionGrid finer = coarsest;
    // Ends: each step doubles the number of steps across the mesh, which `span` bounds, or the
    // exponent comes to its end.
    while (best.check.faults() > 0 && --finer.exponent >= kFinestExponent &&
           std::ldexp(half, -finer.exponent) < span / 2.0 - 1.0) {
        // Only where it helps some of those that need help is it worth a look at all.
        PlanCheck still;
        const Rounding nearest(unit_to_metre, finer);
        for (const auto& corners : suspects) {
            std::array<GridPoint, 3> points{};
            for (std::size_t i = 0; i < 3; ++i)
                points[i] = nearest(mesh.vertices[corners[i]]);
            constexpr std::array<std::uint32_t, 3> kOne{0, 1, 2};
            still.add(check_alone(points, {&kOne, 1}));
        }
        if (still.faults() >= best.check.faults()) continue;
        GridPositions next = at(finer);
        if (next.check.faults() < best.check.faults()) best = std::move(next);
    }
    return best;
}

}  // namespace tinsmith::api
