// SPDX-License-Identifier: Apache-2.0
#include "api/formats/grid_mesh.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/mesh/grid_build.hpp"
#include "core/mesh/grid_cell.hpp"

namespace tinsmith::api {

namespace {

/// The posts around one cell, by corner of the compass (core/mesh/grid_cell.hpp).
using Cell = std::array<std::size_t, 4>;

class Mesher {
  public:
    explicit Mesher(const Grid& grid) : grid_(grid) {}

    /// Calls `each(a, b, c)` for every triangle, cell by cell, counter-clockwise from above.
    template <typename Each>
    void triangles(Each each) const {
        for (std::size_t row = 0; row + 1 < grid_.rows; ++row) {
            for (std::size_t column = 0; column + 1 < grid_.columns; ++column) {
                split(cell(column, row), each);
            }
        }
    }

    core::Point3 post(std::size_t at) const {
        return {grid_.x(at % grid_.columns), grid_.y(at / grid_.columns), grid_.elevations[at]};
    }

  private:
    Cell cell(std::size_t column, std::size_t row) const {
        const std::size_t west = grid_.dx > 0.0 ? column : column + 1;
        const std::size_t east = grid_.dx > 0.0 ? column + 1 : column;
        const std::size_t south = (grid_.dy > 0.0 ? row : row + 1) * grid_.columns;
        const std::size_t north = (grid_.dy > 0.0 ? row + 1 : row) * grid_.columns;
        return {south + west, south + east, north + east, north + west};
    }

    template <typename Each>
    void split(const Cell& cell, Each& each) const {
        const auto z = [&](std::size_t corner) { return grid_.elevations[cell[corner]]; };
        const auto& triangles = core::triangles_of(core::cut_of(z(0), z(1), z(2), z(3)));
        for (unsigned i = 0; i < triangles.count; ++i) {
            const auto [a, b, c] = core::kTriangleWithout[triangles.without[i]];
            each(cell[a], cell[b], cell[c]);
        }
    }

    const Grid& grid_;
};

/// Whether `count` posts from `start` by `step` are all apart in doubles and within the limit.
bool spaced(double start, double step, std::size_t count) {
    double before = start;
    if (std::fabs(start) > kMaxCoordinate) return false;
    for (std::size_t i = 1; i < count; ++i) {
        const double here = start + static_cast<double>(i) * step;
        if (step > 0.0 ? here <= before : here >= before) return false;
        if (!(std::fabs(here) <= kMaxCoordinate)) return false;
        before = here;
    }
    return true;
}

/// The grid's own faults, before any of its elevations is looked at.
std::optional<Parsed<core::MeshData>> refusal(const Grid& grid, const ReadLimits& limits,
                                              const std::string& pointer) {
    const auto refuse = [&](FaultKind kind, std::string code, std::string detail) {
        return Parsed<core::MeshData>(kind,
                                      Fault{std::move(code), std::move(detail), pointer,
                                            std::array<double, 2>{grid.origin.x, grid.origin.y}});
    };
    if (grid.columns < 2 || grid.rows < 2) {
        return refuse(FaultKind::Invalid, "GRID_TOO_SMALL",
                      "A grid needs two columns and two rows to span a triangle.");
    }
    if (grid.elevations.size() > limits.max_vertices ||
        grid.elevations.size() >= UINT32_MAX) {  // posts are numbered with 32 bits below
        return refuse(FaultKind::TooLarge, "TOO_MANY_VERTICES",
                      "The grid has " + std::to_string(grid.elevations.size()) +
                          " posts; at most " + std::to_string(limits.max_vertices) +
                          " are taken here.");
    }
    if (!spaced(grid.origin.x, grid.dx, grid.columns) ||
        !spaced(grid.origin.y, grid.dy, grid.rows)) {
        return refuse(FaultKind::Invalid, "COORDINATE_OUT_OF_RANGE",
                      "The grid's posts leave the range of 1e9, or its cells are so small beside "
                      "its origin that posts fall together.");
    }
    return std::nullopt;
}

}  // namespace

Parsed<core::MeshData> mesh_of_grid(const Grid& grid, const ReadLimits& limits,
                                    const std::string& pointer) {
    if (auto refused = refusal(grid, limits, pointer)) return *std::move(refused);

    const Mesher mesher(grid);
    constexpr std::uint32_t unused = UINT32_MAX;
    std::vector<std::uint32_t> vertex_of(grid.elevations.size(), unused);
    std::size_t triangles = 0;
    mesher.triangles([&](std::size_t a, std::size_t b, std::size_t c) {
        ++triangles;
        for (const std::size_t post : {a, b, c})
            vertex_of[post] = 0;
    });
    if (triangles == 0) {
        return {FaultKind::Invalid,
                {"MESH_EMPTY", "No cell of the grid has three posts with data.", pointer}};
    }
    if (triangles > limits.max_triangles) {
        return {FaultKind::TooLarge,
                {"TOO_MANY_TRIANGLES",
                 "The grid makes " + std::to_string(triangles) + " triangles; at most " +
                     std::to_string(limits.max_triangles) + " are taken here.",
                 pointer}};
    }

    std::uint32_t vertices = 0;
    for (std::uint32_t& vertex : vertex_of) {
        if (vertex != unused) vertex = vertices++;
    }
    core::MeshData mesh;
    mesh.vertices.reserve(vertices);
    for (std::size_t post = 0; post < vertex_of.size(); ++post) {
        if (vertex_of[post] != unused) mesh.vertices.push_back(mesher.post(post));
    }
    mesh.triangles.reserve(triangles);
    mesher.triangles([&](std::size_t a, std::size_t b, std::size_t c) {
        mesh.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
    });
    return mesh;
}

Parsed<Terrain> meshed(Parsed<Terrain> terrain, const ReadLimits& limits) {
    if (!terrain || !terrain->grid) return terrain;
    auto mesh = mesh_of_grid(*terrain->grid, limits);
    if (!mesh) return {mesh.kind(), std::move(mesh.faults())};
    terrain->mesh = *std::move(mesh);
    terrain->grid.reset();
    return terrain;
}

std::optional<core::Tin> tin_of_grid(const Grid& grid, const ReadLimits& limits,
                                     const core::Executor& execute) {
    if (refusal(grid, limits, "")) return std::nullopt;
    return core::build_tin_of_grid(grid, limits.max_triangles, execute);
}

}  // namespace tinsmith::api
