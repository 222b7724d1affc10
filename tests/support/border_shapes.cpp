// SPDX-License-Identifier: Apache-2.0
#include "tests/support/border_shapes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tinsmith::test {

namespace {

using core::MeshData;
using core::Path;
using core::Point2;
using core::Shape;

std::uint32_t add(MeshData& mesh, double x, double y) {
    mesh.vertices.push_back({x, y, std::sin(x * 0.7) + std::cos(y * 1.3)});
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_triangle(MeshData& mesh, Point2 a, Point2 b, Point2 c) {
    const std::uint32_t first = add(mesh, a.x, a.y);
    add(mesh, b.x, b.y);
    add(mesh, c.x, c.y);
    mesh.triangles.push_back({first, first + 1, first + 2});
}

/// A bar from (0, -1) to (n, 0), with a tooth of the given height on each unit of its upper side.
MeshData comb(std::size_t n, double height) {
    MeshData mesh;
    for (std::size_t i = 0; i <= n; ++i) {
        add(mesh, static_cast<double>(i), -1.0);
        add(mesh, static_cast<double>(i), 0.0);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
        mesh.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
        if (height <= 0.0) continue;
        const std::uint32_t tip = add(mesh, i + 0.5, height);
        mesh.triangles.push_back({2 * i + 1, 2 * i + 3, tip});
    }
    return mesh;
}

Shape line(std::vector<Point2> points, bool closed = false) {
    return {{Path{std::move(points), closed}}};
}

/// From x = 0.5 on, one point a step of `step`, low and high in turn.
Shape zigzag(std::size_t points, double step, double low, double high) {
    std::vector<Point2> path;
    for (std::size_t i = 0; i < points; ++i)
        path.push_back({0.5 + static_cast<double>(i) * step, i % 2 == 0 ? low : high});
    return line(std::move(path));
}

Shape ring(Point2 centre, double radius, std::size_t points, double phase) {
    std::vector<Point2> path;
    for (std::size_t i = 0; i < points; ++i) {
        const double angle =
            2.0 * std::numbers::pi * (static_cast<double>(i) + phase) / static_cast<double>(points);
        path.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    return line(std::move(path), true);
}

/// Squares of two triangles, `columns` by `rows`; the squares odd in both numbers are left out.
MeshData sieve(std::size_t columns, std::size_t rows) {
    MeshData mesh;
    for (std::size_t y = 0; y <= rows; ++y)
        for (std::size_t x = 0; x <= columns; ++x)
            add(mesh, static_cast<double>(x), static_cast<double>(y));
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < columns; ++x) {
            if (x % 2 == 1 && y % 2 == 1) continue;
            const auto a = static_cast<std::uint32_t>(y * (columns + 1) + x);
            const auto c = static_cast<std::uint32_t>(a + columns + 1);
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
    return mesh;
}

/// A fan of n triangles around the origin, of the given share of a full turn, radius 1.
MeshData fan(std::size_t n, double share) {
    MeshData mesh;
    add(mesh, 0.0, 0.0);
    const bool closed = share >= 1.0;
    for (std::size_t i = 0; i < n + (closed ? 0 : 1); ++i) {
        const double angle =
            2.0 * std::numbers::pi * share * static_cast<double>(i) / static_cast<double>(n);
        add(mesh, std::cos(angle), std::sin(angle));
    }
    for (std::uint32_t i = 0; i < n; ++i)
        mesh.triangles.push_back({0, i + 1, closed && i + 1 == n ? 1 : i + 2});
    return mesh;
}

double root(std::size_t n) {
    return std::floor(std::sqrt(static_cast<double>(n)));
}

BorderCase comb_one_segment(std::size_t n) {
    const auto width = static_cast<double>(n);
    return {comb(n, 1.0), {}, {line({{-1.0, 0.5}, {width + 1.0, 0.5}})}};
}

BorderCase comb_tall(std::size_t n) {
    const auto width = static_cast<double>(n);
    return {comb(n, width), {}, {line({{-1.0, width / 2.0}, {width + 1.0, width / 3.0}})}};
}

BorderCase comb_zigzag(std::size_t n) {
    return {comb(n, 1.0), {}, {zigzag(2 * n, 0.5, 0.6, 0.7)}};
}

BorderCase comb_back_and_forth(std::size_t n) {
    const auto teeth = static_cast<std::size_t>(root(n));
    const auto width = static_cast<double>(teeth);
    std::vector<Point2> path;
    for (std::size_t i = 0; i < teeth; ++i) {
        const double y = 0.2 + 0.6 * static_cast<double>(i) / width;
        path.push_back({i % 2 == 0 ? -1.0 : width + 1.0, y});
        path.push_back({i % 2 == 0 ? width + 1.0 : -1.0, y});
    }
    return {comb(teeth, 1.0), {}, {line(std::move(path))}};
}

BorderCase straight_zigzag(std::size_t n) {
    return {comb(n, 0.0), {}, {zigzag(n - 1, 1.0, -0.2, 0.2)}};
}

BorderCase one_edge_zigzag(std::size_t n) {
    const auto width = static_cast<double>(n);
    MeshData mesh;
    add_triangle(mesh, {0.0, 0.0}, {width / 2.0, -width}, {width, 0.0});
    return {std::move(mesh), {}, {zigzag(n - 1, 1.0, -0.2, 0.2)}};
}

BorderCase along_the_border(std::size_t n) {
    // Outside all the way, near the border, meeting it at the end only.
    Shape shape = zigzag(n - 1, 1.0, 0.2, 0.3);
    shape.paths[0].points.push_back({static_cast<double>(n) - 0.4, -0.5});
    return {comb(n, 0.0), {}, {std::move(shape)}};
}

BorderCase holes_one_segment(std::size_t n) {
    const auto width = static_cast<double>(2 * n + 1);
    return {sieve(2 * n + 1, 3), {}, {line({{-1.0, 1.4}, {width + 1.0, 1.6}})}};
}

BorderCase holes_snake(std::size_t n) {
    const auto rows = static_cast<std::size_t>(2.0 * root(n) + 1.0);
    const auto width = static_cast<double>(rows);
    std::vector<Point2> path;
    for (std::size_t y = 1; y < rows; y += 2)
        for (const bool right : {y % 4 == 3, y % 4 == 1})
            path.push_back({right ? width + 1.0 : -1.0, static_cast<double>(y) + 0.6});
    return {sieve(rows, rows), {}, {line(std::move(path))}};
}

BorderCase holes_many_points(std::size_t n) {
    const auto rows = static_cast<std::size_t>(2.0 * root(n) + 1.0);
    BorderCase made{sieve(rows, rows), {}, {Shape{}}};
    for (std::size_t y = 0; y + 1 < rows; ++y)
        for (std::size_t x = 0; x + 1 < rows; x += 4)
            made.shapes[0].paths.push_back(
                {{{static_cast<double>(x) + 0.4, static_cast<double>(y) + 0.6}}});
    return made;
}

BorderCase components_one_segment(std::size_t n) {
    MeshData mesh;
    for (std::size_t i = 0; i < n; ++i) {
        const auto x = static_cast<double>(i);
        add_triangle(mesh, {x, 0.0}, {x + 0.8, 0.0}, {x + 0.4, 1.0});
    }
    const auto width = static_cast<double>(n);
    return {std::move(mesh), {}, {line({{-1.0, 0.3}, {width + 1.0, 0.6}})}};
}

BorderCase components_many_rings(std::size_t n) {
    BorderCase made;
    const double columns = root(n);
    for (double y = 0.0; y < columns; ++y)
        for (double x = 0.0; x < columns; ++x) {
            add_triangle(made.mesh, {x, y}, {x + 0.8, y}, {x + 0.4, y + 0.8});
            made.shapes.push_back(ring({x + 0.4, y + 0.4}, 0.3, 7, 0.3));
        }
    return made;
}

BorderCase touching_chain(std::size_t n) {
    // Lozenges that touch in points, all on one segment.
    MeshData mesh;
    for (std::size_t i = 0; i < n; ++i) {
        const auto x = static_cast<double>(i);
        add_triangle(mesh, {x, 0.0}, {x + 0.5, -0.5}, {x + 1.0, 0.0});
    }
    const auto width = static_cast<double>(n);
    return {std::move(mesh), {}, {line({{-1.0, 0.0}, {width + 1.0, 0.0}})}};
}

BorderCase touching_fans(std::size_t n) {
    // n components, all touching in one vertex; a ring around it, and a line through it.
    MeshData mesh;
    for (std::size_t i = 0; i < n; ++i) {
        const double turn = 2.0 * std::numbers::pi / static_cast<double>(n);
        const double angle = turn * static_cast<double>(i);
        add_triangle(mesh, {0.0, 0.0}, {std::cos(angle), std::sin(angle)},
                     {std::cos(angle + turn / 2.0), std::sin(angle + turn / 2.0)});
    }
    return {
        std::move(mesh), {}, {ring({0.0, 0.0}, 0.5, 64, 0.3), line({{-2.0, -1.0}, {2.0, 1.0}})}};
}

BorderCase hub_ring(std::size_t n) {
    return {fan(n, 1.0), {}, {ring({0.0, 0.0}, 0.5, 64, 0.3)}};
}

BorderCase hub_passes(std::size_t n) {
    // sqrt(n) passes: what each costs is linear in the hub's triangles only if it is looked
    // through.
    std::vector<Point2> path;
    for (double i = 0.0; i < root(n); ++i) {
        const double angle = 2.3 * i + 0.1;
        path.push_back({0.5 * std::cos(angle), 0.5 * std::sin(angle)});
        path.push_back({0.0, 0.0});
    }
    return {fan(n, 1.0), {}, {line(std::move(path))}};
}

BorderCase hub_on_the_border(std::size_t n) {
    // Half a fan; a zig-zag over the one border edge that starts at its hub.
    std::vector<Point2> path;
    for (std::size_t i = 0; i < n; ++i)
        path.push_back({0.05 + 0.9 * static_cast<double>(i) / static_cast<double>(n),
                        i % 2 == 0 ? -1e-6 : 1e-6});
    return {fan(n, 0.5), {}, {line(std::move(path))}};
}

BorderCase hub_in_a_facet(std::size_t n) {
    // One triangle, divided by a ring around a point: the second ring crosses n edges of one facet.
    MeshData mesh;
    add_triangle(mesh, {-4.0, -3.0}, {4.0, -3.0}, {0.0, 5.0});
    return {std::move(mesh),
            {ring({0.0, 0.0}, 1.0, n, 0.0), line({{0.0, 0.0}, {0.0, 1e-9}})},
            {ring({0.0, 0.0}, 0.5, 64, 0.3), line({{-2.0, -1.0}, {2.0, 1.0}})}};
}

BorderCase rings_that_cross(std::size_t n) {
    MeshData mesh;
    add_triangle(mesh, {-4.0, -3.0}, {4.0, -3.0}, {0.0, 5.0});
    return {std::move(mesh), {}, {ring({0.0, 0.0}, 1.0, n, 0.0), ring({0.0, 0.0}, 1.0, n, 0.5)}};
}

BorderCase spike_combs(std::size_t n) {
    // A path that crosses its own sqrt(n) long strokes sqrt(n) times each.
    MeshData mesh;
    add_triangle(mesh, {-4.0, -3.0}, {4.0, -3.0}, {0.0, 5.0});
    std::vector<Point2> path;
    const double strokes = root(n);
    for (const bool upright : {false, true})
        for (double i = 0.0; i < strokes; ++i)
            for (const double end : {-0.5, 0.5}) {
                const double side = static_cast<int>(i) % 2 == 0 ? end : -end;
                const double at = 0.9 * (i + 0.3) / strokes - 0.45;
                path.push_back(upright ? Point2{at, side} : Point2{side, at});
            }
    return {std::move(mesh), {}, {line(std::move(path))}};
}

constexpr std::array kShapes{
    BorderShape{"comb_one_segment", comb_one_segment},
    BorderShape{"comb_tall", comb_tall},
    BorderShape{"comb_zigzag", comb_zigzag},
    BorderShape{"comb_back_and_forth", comb_back_and_forth},
    BorderShape{"straight_zigzag", straight_zigzag},
    BorderShape{"one_edge_zigzag", one_edge_zigzag},
    BorderShape{"along_the_border", along_the_border},
    BorderShape{"holes_one_segment", holes_one_segment},
    BorderShape{"holes_snake", holes_snake},
    BorderShape{"holes_many_points", holes_many_points},
    BorderShape{"components_one_segment", components_one_segment},
    BorderShape{"components_many_rings", components_many_rings},
    BorderShape{"touching_chain", touching_chain},
    BorderShape{"touching_fans", touching_fans},
    BorderShape{"hub_ring", hub_ring},
    BorderShape{"hub_passes", hub_passes},
    BorderShape{"hub_on_the_border", hub_on_the_border},
    BorderShape{"hub_in_a_facet", hub_in_a_facet},
    BorderShape{"rings_that_cross", rings_that_cross},
    BorderShape{"spike_combs", spike_combs},
};

}  // namespace

std::span<const BorderShape> border_shapes() {
    return kShapes;
}

}  // namespace tinsmith::test
