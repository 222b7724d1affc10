// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_input.hpp"

#include <algorithm>
#include <cmath>

namespace tinsmith::test {

using core::MeshData;
using core::Path;
using core::Point2;
using core::Point3;
using core::Shape;

double uniform(Random& random, double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

namespace {

int pick(Random& random, int count) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(count));
}

bool is_missing(Random& random, MeshKind kind, int column, int row, int columns) {
    const bool rim = column == 0 || row == 0 || column == columns - 1 || row == columns - 1;
    if (kind == MeshKind::Concave) return rim && pick(random, 3) == 0;
    return kind == MeshKind::Holes && pick(random, 4) == 0;
}

/// Drops vertices that no triangle uses.
MeshData compact(const MeshData& full) {
    MeshData mesh;
    std::vector<std::uint32_t> slot(full.vertices.size(), UINT32_MAX);
    for (auto t : full.triangles) {
        for (std::uint32_t& v : t) {
            if (slot[v] == UINT32_MAX) {
                slot[v] = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(full.vertices[v]);
            }
            v = slot[v];
        }
        mesh.triangles.push_back(t);
    }
    return mesh;
}

}  // namespace

MeshData random_mesh(Random& random, MeshKind kind, int columns) {
    MeshData mesh;
    const bool jitter =
        kind != MeshKind::Grid && kind != MeshKind::Holes && kind != MeshKind::Needles;
    const double scale = kind == MeshKind::FarAway ? 1e-3 : 1.0;
    const double offset = kind == MeshKind::FarAway ? 5e6 : 0.0;
    const double squeeze = kind == MeshKind::Needles ? 1e-9 : 1.0;
    for (int row = 0; row <= columns; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double dx = jitter ? uniform(random, -0.2, 0.2) : 0.0;
            const double dy = jitter ? uniform(random, -0.2, 0.2) : 0.0;
            mesh.vertices.push_back({offset + (column + dx) * scale,
                                     offset + (row + dy) * scale * squeeze,
                                     uniform(random, 0.0, 3.0) * scale * squeeze});
        }
    }
    for (int row = 0; row < columns; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (columns > 1 && is_missing(random, kind, column, row, columns)) continue;
            const auto post = [columns](int c, int r) {
                return static_cast<std::uint32_t>(r * (columns + 1) + c);
            };
            const std::uint32_t a = post(column, row), b = post(column + 1, row);
            const std::uint32_t c = post(column + 1, row + 1), d = post(column, row + 1);
            if (pick(random, 2) == 0) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, c, d});
            }
        }
    }
    return compact(mesh);
}

Shape random_shape(Random& random, ShapeKind kind, const MeshData& mesh) {
    Point2 low = mesh.vertices[0].plan(), high = low;
    for (const Point3& v : mesh.vertices) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y)};
    }
    const double width = high.x - low.x, height = high.y - low.y;
    const auto anywhere = [&] {  // a tenth beyond the mesh on every side
        const double x = uniform(random, low.x - 0.1 * width, high.x + 0.1 * width);
        return Point2{x, uniform(random, low.y - 0.1 * height, high.y + 0.1 * height)};
    };
    const auto on_lattice = [&]() -> Point2 {
        const auto& t = mesh.triangles[random() % mesh.triangles.size()];
        const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        switch (pick(random, 4)) {
            case 0:
                return {(a.x + b.x) / 2, (a.y + b.y) / 2};
            case 1:
                return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
            default:
                return a.plan();
        }
    };
    Path path;
    const int count = 3 + pick(random, 12);
    switch (kind) {
        case ShapeKind::Ring: {
            const Point2 centre = anywhere();
            const double radius = uniform(random, 0.05, 0.7);
            for (int i = 0; i < count; ++i) {
                const double turn = 6.283185307179586 * (i + uniform(random, 0.0, 0.8)) / count;
                const double r = radius * uniform(random, 0.5, 1.0);
                path.points.push_back({centre.x + width * r * std::cos(turn),
                                       centre.y + height * r * std::sin(turn)});
            }
            path.closed = true;
            break;
        }
        case ShapeKind::Line:
        case ShapeKind::Tangled:
            for (int i = 0; i < count; ++i)
                path.points.push_back(anywhere());
            path.closed = kind == ShapeKind::Tangled;
            break;
        case ShapeKind::Lattice:
            for (int i = 0; i < count; ++i)
                path.points.push_back(on_lattice());
            path.closed = pick(random, 2) == 0;
            break;
        case ShapeKind::Spike: {
            const Point2 a = anywhere(), b = on_lattice(), c = anywhere();
            path.points = {a, b, c, b, a};
            break;
        }
        case ShapeKind::Tiny: {
            const Point2 centre = on_lattice();
            const double size = std::pow(10.0, uniform(random, -8.0, -1.0));
            for (int i = 0; i < count; ++i)
                path.points.push_back({centre.x + size * width * uniform(random, -1.0, 1.0),
                                       centre.y + size * height * uniform(random, -1.0, 1.0)});
            path.closed = true;
            break;
        }
    }
    return {{path}};
}

}  // namespace tinsmith::test
