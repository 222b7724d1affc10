// SPDX-License-Identifier: Apache-2.0
#include "tests/digest/ground.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::digest {

using core::MeshData;
using core::Path;
using core::Point2;
using core::Shape;

Ground make_ground(Ground::Kind kind, std::uint32_t columns) {
    Ground ground{kind, columns, {}};
    switch (kind) {
        case Ground::Kind::Grid:
        case Ground::Kind::Jittered:
        case Ground::Kind::Holes:
            break;
        case Ground::Kind::Needles:
            ground.along = ground.height = 0x1p-30;
            break;
        case Ground::Kind::FarAway:
            ground.origin = {5e6, 5e6};
            ground.across = ground.along = 0x1p-10;
            ground.height = 0x1p-8;
            break;
        case Ground::Kind::Steep:
            ground.height = 2048.0;
            break;
        case Ground::Kind::Map:
            ground.origin = {731728.3, 4004667.7};
            ground.across = ground.along = 32.0;
            ground.height = 64.0;
            break;
    }
    return ground;
}

namespace {

/// Only the vertices that triangles use, in their order.
MeshData compact(const MeshData& mesh) {
    std::vector<std::uint32_t> slot(mesh.vertices.size(), UINT32_MAX);
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t)
            slot[v] = 0;
    MeshData result;
    for (std::size_t v = 0; v < slot.size(); ++v) {
        if (slot[v] == UINT32_MAX) continue;
        slot[v] = static_cast<std::uint32_t>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
    }
    for (const auto& [a, b, c] : mesh.triangles)
        result.triangles.push_back({slot[a], slot[b], slot[c]});
    return result;
}

}  // namespace

MeshData make_mesh(Dice& dice, const Ground& ground) {
    const bool moved = ground.kind == Ground::Kind::Jittered ||
                       ground.kind == Ground::Kind::FarAway || ground.kind == Ground::Kind::Steep ||
                       ground.kind == Ground::Kind::Map;
    MeshData mesh;
    for (std::uint32_t row = 0; row <= ground.columns; ++row) {
        for (std::uint32_t column = 0; column <= ground.columns; ++column) {
            double x = column, y = row;
            if (moved) {
                x += dice.unit() * 0.25;
                y += dice.unit() * 0.25;
            }
            const Point2 p = ground.at(x, y);
            mesh.vertices.push_back({p.x, p.y, dice.unit() * ground.height});
        }
    }
    for (std::uint32_t row = 0; row < ground.columns; ++row) {
        for (std::uint32_t column = 0; column < ground.columns; ++column) {
            if (ground.kind == Ground::Kind::Holes && dice.one_in(4)) continue;
            const std::uint32_t a = row * (ground.columns + 1) + column, b = a + 1;
            const std::uint32_t d = a + ground.columns + 1, c = d + 1;
            if (dice.one_in(2)) {
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

namespace {

/// Cosines of a sixteenth of a turn and its multiples, in 256ths: whole numbers, not the library's.
constexpr std::array<int, 16> kCosines{256,  237,  181,  98,  0, -98, -181, -237,
                                       -256, -237, -181, -98, 0, 98,  181,  237};

class Sketch {
  public:
    Sketch(Dice& dice, const Ground& ground) : dice_(dice), ground_(ground) {}

    Shape draw() {
        switch (dice_.below(12)) {
            case 0:
                return {{line(2 + dice_.below(8), &Sketch::anywhere)}};
            case 1:
                return {{closed(line(3 + dice_.below(8), &Sketch::anywhere))}};  // tangled
            case 2:
                return {{closed(line(3 + dice_.below(8), &Sketch::on_lattice))}};
            case 3:
                return {{line(2 + dice_.below(8), &Sketch::near_lattice)}};
            case 4:
                return {{closed(line(3 + dice_.below(6), &Sketch::near_lattice))}};
            case 5:
                return spike();
            case 6:
                return {{tiny_ring()}};
            case 7:
                return holed();
            case 8:
                return several(&Sketch::one_ring);
            case 9:
                return several(&Sketch::one_point);
            case 10:
                return sliver();
            default:
                return {{one_ring()}};
        }
    }

    /// A column or row on the ground or half a cell beyond.
    double column() {
        const double whole = dice_.below(ground_.columns + 1);
        return whole + (dice_.unit() - 0.5);
    }

  private:
    Point2 anywhere() {
        const double x = column();
        return ground_.at(x, column());
    }
    /// On posts, in the middle of edges and of cells.
    Point2 on_lattice() {
        const double x = 0.5 * dice_.below(2 * ground_.columns + 1);
        return ground_.at(x, 0.5 * dice_.below(2 * ground_.columns + 1));
    }
    Point2 near_lattice() {
        const Point2 p = on_lattice();
        const double x = nudged(p.x);
        return {x, nudged(p.y)};
    }
    double nudged(double x) {
        const bool up = dice_.one_in(2);
        double result = x;
        for (std::uint32_t i = dice_.below(5); i > 0; --i)
            result = core::neighbour(result, up);
        // Next to zero ulps are smaller than what the core takes as a coordinate.
        return core::in_coordinate_range(result) ? result : x;
    }

    Path line(std::uint32_t count, Point2 (Sketch::*place)()) {
        Path path;
        while (path.points.size() < count)
            path.points.push_back((this->*place)());
        return path;
    }
    static Path closed(Path path) {
        path.closed = true;
        return path;
    }
    /// Star-shaped around a column and row; `scale` cells wide, a power of two.
    Path ring(double x, double y, double scale) {
        Path path;
        path.closed = true;
        const std::uint32_t step = 1 + dice_.below(3);
        for (std::uint32_t turn = 0; turn < 16; turn += step) {
            const int radius = 32 + static_cast<int>(dice_.below(33));
            const double dx = radius * kCosines[turn];
            const double dy = radius * kCosines[(turn + 12) % 16];
            path.points.push_back(ground_.at(x + dx * scale * 0x1p-14, y + dy * scale * 0x1p-14));
        }
        return path;
    }
    Path one_ring() {
        const double x = column(), y = column();
        return ring(x, y, dice_.one_in(2) ? 1.0 : 2.0);
    }
    Path tiny_ring() {
        const double x = column(), y = column();
        return ring(x, y, 0x1p-20);
    }
    Path one_point() { return line(1, dice_.one_in(2) ? &Sketch::anywhere : &Sketch::on_lattice); }

    Shape several(Path (Sketch::*one)()) {
        Shape shape;
        for (std::uint32_t count = 2 + dice_.below(3); count > 0; --count)
            shape.paths.push_back((this->*one)());
        return shape;
    }
    /// Concave, with rings inside that run the other way.
    Shape holed() {
        const double x = column(), y = column();
        Shape shape{{ring(x, y, 2.0)}};
        for (std::uint32_t count = 1 + dice_.below(2); count > 0; --count) {
            Path hole = ring(x + 0.25 * dice_.below(2), y, 0.25);
            std::reverse(hole.points.begin(), hole.points.end());
            shape.paths.push_back(std::move(hole));
        }
        return shape;
    }
    Shape spike() {
        const Point2 a = anywhere(), b = on_lattice(), c = anywhere();
        return {{{{a, b, c, b, a}, false}}};
    }
    /// Much longer than it is wide.
    Shape sliver() {
        const double x = column(), y = column(), far = column();
        const std::array<double, 4> widths{0x1p-4, 0x1p-12, 0x1p-24, 0x1p-40};
        const double width = widths[dice_.below(4)];
        return {{{{ground_.at(x, y), ground_.at(far, x), ground_.at(far, x + width),
                   ground_.at(x, y + width)},
                  true}}};
    }

    Dice& dice_;
    const Ground& ground_;
};

}  // namespace

Shape make_shape(Dice& dice, const Ground& ground) {
    return Sketch(dice, ground).draw();
}

void give_elevations(Dice& dice, const Ground& ground, Shape& shape) {
    for (Path& path : shape.paths) {
        for (const Point2 p : path.points) {
            const auto known = std::find(path.points.begin(), path.points.end(), p);
            const auto place = static_cast<std::size_t>(known - path.points.begin());
            path.elevations.push_back(place < path.elevations.size()
                                          ? path.elevations[place]
                                          : dice.unit() * ground.height * 2.0);
        }
    }
}

Path make_post_line(Dice& dice, const Ground& ground) {
    Path path;
    const double row = dice.below(ground.columns + 1);
    path.points = {ground.at(0, row), ground.at(ground.columns, row)};
    if (dice.one_in(2)) path.points.push_back(ground.at(0, 0));
    return path;
}

}  // namespace tinsmith::digest
