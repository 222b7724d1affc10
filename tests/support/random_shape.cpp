// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tests/support/random_input.hpp"

namespace tinsmith::test {

using core::MeshData;
using core::Path;
using core::Point2;
using core::Point3;
using core::Shape;

namespace {

/// Draws positions and paths on and around one mesh.
class Sketch {
  public:
    Sketch(Random& random, const MeshData& mesh) : random_(random), mesh_(mesh) {
        low_ = high_ = mesh.vertices[0].plan();
        for (const Point3& v : mesh.vertices) {
            low_ = {std::min(low_.x, v.x), std::min(low_.y, v.y)};
            high_ = {std::max(high_.x, v.x), std::max(high_.y, v.y)};
        }
        width_ = high_.x - low_.x;
        height_ = high_.y - low_.y;
    }

    Shape draw(ShapeKind kind) {
        switch (kind) {
            case ShapeKind::Ring:
                return {{ring(anywhere(), uniform(random_, 0.05, 0.7))}};
            case ShapeKind::Line:
                return {{points_at(count(), false, [&] { return anywhere(); })}};
            case ShapeKind::Tangled:
                return {{points_at(count(), true, [&] { return anywhere(); })}};
            case ShapeKind::Lattice:
                return {{points_at(count(), pick(random_, 2) == 0, [&] { return on_lattice(); })}};
            case ShapeKind::Spike: {
                const Point2 a = anywhere(), b = on_lattice(), c = anywhere();
                return {{{{a, b, c, b, a}, false}}};
            }
            case ShapeKind::Tiny:
                return {{tiny()}};
            case ShapeKind::Holed:
                return holed();
            case ShapeKind::Rings:
                return several([&] { return ring(anywhere(), uniform(random_, 0.05, 0.4)); });
            case ShapeKind::Lines:
                return several([&] {
                    return points_at(2 + pick(random_, 3), false, [&] { return anywhere(); });
                });
            case ShapeKind::Points:
                return several([&] {
                    const Point2 p = pick(random_, 2) == 0 ? anywhere() : on_lattice();
                    return Path{std::vector<Point2>(1 + random_() % 2, p), false};
                });
            case ShapeKind::Repeated:
                return {{repeated()}};
            case ShapeKind::NearLattice:
                return {{points_at(count(), pick(random_, 2) == 0,
                                   [&] { return moved_by_ulps(on_lattice()); })}};
            case ShapeKind::Sliver:
                return {{sliver()}};
            case ShapeKind::Around:
                return {{around()}};
            case ShapeKind::AlongEdges:
                return {{along_edges()}};
            case ShapeKind::OneTriangle:
                return {{in_one_triangle()}};
        }
        return {};
    }

  private:
    int count() { return 3 + pick(random_, 12); }

    /// A tenth beyond the mesh on every side.
    Point2 anywhere() {
        const double x = uniform(random_, low_.x - 0.1 * width_, high_.x + 0.1 * width_);
        return {x, uniform(random_, low_.y - 0.1 * height_, high_.y + 0.1 * height_)};
    }
    std::array<Point2, 3> any_triangle() {
        const auto& [a, b, c] = mesh_.triangles[random_() % mesh_.triangles.size()];
        return {mesh_.vertices[a].plan(), mesh_.vertices[b].plan(), mesh_.vertices[c].plan()};
    }
    Point2 on_lattice() {
        const auto [a, b, c] = any_triangle();
        switch (pick(random_, 4)) {
            case 0:
                return {(a.x + b.x) / 2, (a.y + b.y) / 2};
            case 1:
                return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
            default:
                return a;
        }
    }
    Point2 moved_by_ulps(Point2 p) {
        for (double* x : {&p.x, &p.y})
            for (int steps = pick(random_, 9) - 4; steps != 0; steps += steps < 0 ? 1 : -1)
                *x = std::nextafter(*x, steps < 0 ? low_.x - 1e9 : high_.x + 1e9);
        // Next to zero ulps are smaller than what the core takes as a coordinate.
        if (std::fabs(p.x) < 1e-100) p.x = 0.0;
        if (std::fabs(p.y) < 1e-100) p.y = 0.0;
        return p;
    }

    template <typename Place>
    static Path points_at(int count, bool closed, const Place& place) {
        Path path;
        path.closed = closed;
        for (int i = 0; i < count; ++i)
            path.points.push_back(place());
        return path;
    }

    /// `size`: of the mesh's width.
    Path ring(Point2 centre, double size, double least = 0.5) {
        Path path;
        path.closed = true;
        const int n = count();
        for (int i = 0; i < n; ++i) {
            const double turn = 6.283185307179586 * (i + uniform(random_, 0.0, 0.8)) / n;
            const double r = size * uniform(random_, least, 1.0);
            path.points.push_back(
                {centre.x + width_ * r * std::cos(turn), centre.y + height_ * r * std::sin(turn)});
        }
        return path;
    }
    Path tiny() {
        const Point2 centre = on_lattice();
        const double size = std::pow(10.0, uniform(random_, -8.0, -1.0));
        return points_at(count(), true, [&]() -> Point2 {
            const double x = centre.x + size * width_ * uniform(random_, -1.0, 1.0);
            return {x, centre.y + size * height_ * uniform(random_, -1.0, 1.0)};
        });
    }
    Shape holed() {
        const Point2 centre = anywhere();
        const double size = uniform(random_, 0.2, 0.6);
        Shape shape{{ring(centre, size, 0.8)}};
        const int holes = 1 + pick(random_, 2);
        for (int i = 0; i < holes; ++i) {
            Path hole = ring({centre.x + size * width_ * uniform(random_, -0.3, 0.3),
                              centre.y + size * height_ * uniform(random_, -0.3, 0.3)},
                             size * uniform(random_, 0.05, 0.35));
            std::reverse(hole.points.begin(), hole.points.end());
            shape.paths.push_back(std::move(hole));
        }
        return shape;
    }
    template <typename Draw>
    Shape several(const Draw& draw_one) {
        Shape shape;
        const int n = 2 + pick(random_, 3);
        for (int i = 0; i < n; ++i)
            shape.paths.push_back(draw_one());
        return shape;
    }
    Path repeated() {
        Path path;
        path.closed = pick(random_, 2) == 0;
        for (int i = count(); i > 0; --i) {
            const bool again = !path.points.empty() && pick(random_, 3) == 0;
            const Point2 p = again ? path.points[random_() % path.points.size()] : anywhere();
            path.points.insert(path.points.end(), 1 + random_() % 2, p);
        }
        return path;
    }
    Path sliver() {
        const Point2 a = anywhere(), b = anywhere();
        const double wide = std::pow(10.0, uniform(random_, -12.0, -2.0));
        const double dx = -(b.y - a.y) / height_ * width_ * wide;
        const double dy = (b.x - a.x) / width_ * height_ * wide;
        return {{a, b, {b.x + dx, b.y + dy}, {a.x + dx, a.y + dy}}, true};
    }
    Path around() {
        const double beyond = pick(random_, 3) == 0 ? 0.0 : uniform(random_, -0.01, 0.2);
        const double x = beyond * width_, y = beyond * height_;
        return {{{low_.x - x, low_.y - y},
                 {high_.x + x, low_.y - y},
                 {high_.x + x, high_.y + y},
                 {low_.x - x, high_.y + y}},
                true};
    }
    /// From a vertex on to any neighbour, and so on.
    Path along_edges() {
        Path path;
        std::uint32_t at = mesh_.triangles[random_() % mesh_.triangles.size()][0];
        for (int i = count(); i > 0; --i) {
            path.points.push_back(mesh_.vertices[at].plan());
            std::vector<std::uint32_t> around;
            for (const auto& t : mesh_.triangles)
                if (std::find(t.begin(), t.end(), at) != t.end())
                    for (const std::uint32_t v : t)
                        if (v != at) around.push_back(v);
            at = around[random_() % around.size()];
        }
        return path;
    }
    Path in_one_triangle() {
        const auto [a, b, c] = any_triangle();
        return points_at(5 + pick(random_, 25), pick(random_, 2) == 0, [&]() -> Point2 {
            double s = uniform(random_, 0.0, 1.0), t = uniform(random_, 0.0, 1.0);
            if (s + t > 1.0) {
                s = 1.0 - s;
                t = 1.0 - t;
            }
            return {a.x + s * (b.x - a.x) + t * (c.x - a.x),
                    a.y + s * (b.y - a.y) + t * (c.y - a.y)};
        });
    }

    Random& random_;
    const MeshData& mesh_;
    Point2 low_;
    Point2 high_;
    double width_ = 0.0;
    double height_ = 0.0;
};

}  // namespace

Shape random_shape(Random& random, ShapeKind kind, const MeshData& mesh) {
    return Sketch(random, mesh).draw(kind);
}

void give_elevations(Random& random, Shape& shape, const MeshData& mesh) {
    const auto [low, high] =
        std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                            [](const Point3& l, const Point3& r) { return l.z < r.z; });
    const double spread = high->z - low->z;
    // A position has one elevation however often it comes.
    std::map<std::pair<double, double>, double> known;
    for (Path& path : shape.paths) {
        for (const Point2 p : path.points) {
            const double z = uniform(random, low->z - 0.5 * spread, high->z + 0.5 * spread);
            path.elevations.push_back(known.try_emplace({p.x, p.y}, z).first->second);
        }
    }
}

}  // namespace tinsmith::test
