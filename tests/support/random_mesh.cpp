// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "tests/support/compact.hpp"
#include "tests/support/delaunay.hpp"
#include "tests/support/random_input.hpp"

namespace tinsmith::test {

using core::MeshData;
using core::Point3;

double uniform(Random& random, double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

int pick(Random& random, int count) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(count));
}

const char* name_of(MeshKind kind) {
    constexpr std::array<const char*, kMeshKinds> kNames{
        "Grid",     "Jittered", "Concave", "Holes", "Needles", "FarAway",
        "Delaunay", "Steep",    "Flat",    "Map",   "Strips",  "Islands"};
    return kNames.at(static_cast<std::size_t>(kind));
}

namespace {

/// Where unit cells and unit heights go.
struct Placement {
    double x = 0.0, y = 0.0;           ///< offset
    double across = 1.0, along = 1.0;  ///< size of a cell
    double height = 3.0;               ///< elevations are from 0 to this
    double slant = 0.0;                ///< of columns
};

Placement placement_of(Random& random, MeshKind kind) {
    switch (kind) {
        case MeshKind::Needles:
            return {0.0, 0.0, 1.0, 1e-9, 3e-9};
        case MeshKind::FarAway:
            return {5e6, 5e6, 1e-3, 1e-3, 3e-3};
        case MeshKind::Steep:
            return {0.0, 0.0, 1.0, 1.0, 2000.0};
        case MeshKind::Map:
            return {5e5 + uniform(random, 0, 9), 5e6 + uniform(random, 0, 9), 25.0, 25.0, 40.0};
        case MeshKind::Strips:
            return {uniform(random, -1, 1), 0.0, 1e-2, 100.0, 3.0, uniform(random, -40, 40)};
        default:
            return {};
    }
}

MeshData grid_mesh(Random& random, MeshKind kind, int columns) {
    MeshData mesh;
    const bool jitter = kind != MeshKind::Grid && kind != MeshKind::Holes &&
                        kind != MeshKind::Needles && kind != MeshKind::Strips;
    const Placement at = placement_of(random, kind);
    for (int row = 0; row <= columns; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double x = column + (jitter ? uniform(random, -0.2, 0.2) : 0.0);
            const double y = row + (jitter ? uniform(random, -0.2, 0.2) : 0.0);
            const double z =
                kind == MeshKind::Flat ? 0.3 * x - 0.7 * y : uniform(random, 0.0, at.height);
            mesh.vertices.push_back({at.x + x * at.across + y * at.slant, at.y + y * at.along, z});
        }
    }
    const auto is_missing = [&](int column, int row) {
        const bool rim = column == 0 || row == 0 || column == columns - 1 || row == columns - 1;
        if (kind == MeshKind::Concave) return rim && pick(random, 3) == 0;
        return kind == MeshKind::Holes && pick(random, 4) == 0;
    };
    for (int row = 0; row < columns; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (columns > 1 && is_missing(column, row)) continue;
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

/// Triangulated random points. The lattice's triangles are at least 2^-21 high on a side of 1, far
/// beyond what rounding of the placed corners can turn over.
MeshData scattered_mesh(Random& random, const Placement& at, int columns) {
    constexpr std::int64_t kSteps = 1 << 20;
    std::set<LatticePoint> distinct;
    const int count = 3 + pick(random, columns * columns + 2);
    const bool clustered = pick(random, 3) == 0;
    for (int i = 0; i < count; ++i) {
        const auto coordinate = [&] {
            const double place = uniform(random, 0.0, 1.0);
            return static_cast<std::int64_t>((clustered ? place * place * place : place) *
                                             static_cast<double>(kSteps));
        };
        const std::int64_t x = coordinate();
        distinct.insert({x, coordinate()});
    }
    const std::vector<LatticePoint> points(distinct.begin(), distinct.end());
    MeshData mesh;
    const double step = columns / static_cast<double>(kSteps);
    for (const LatticePoint& p : points)
        mesh.vertices.push_back({at.x + static_cast<double>(p.x) * step * at.across,
                                 at.y + static_cast<double>(p.y) * step * at.along,
                                 uniform(random, 0.0, at.height)});
    const int missing = pick(random, 3) == 0 ? 5 : 0;  // one triangle in so many
    for (const auto& t : delaunay(points))
        if (missing == 0 || pick(random, missing) != 0) mesh.triangles.push_back(t);
    return compact(mesh);
}

MeshData islands(Random& random, int columns) {
    MeshData all;
    const int count = 2 + pick(random, 3);
    double x = 0.0;
    for (int i = 0; i < count; ++i) {
        const Placement at{x, uniform(random, 0.0, 2.0)};
        const int size = 1 + pick(random, std::max(1, columns / 2));
        const MeshData one = scattered_mesh(random, at, size);
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
        for (const auto& [a, b, c] : one.triangles)
            all.triangles.push_back({a + first, b + first, c + first});
        x += size + uniform(random, 0.01, 1.0);
    }
    return all;
}

}  // namespace

MeshData random_mesh(Random& random, MeshKind kind, int columns) {
    switch (kind) {
        case MeshKind::Delaunay:
        case MeshKind::Map:
            return scattered_mesh(random, placement_of(random, kind), columns);
        case MeshKind::Islands:
            return islands(random, columns);
        default:
            return grid_mesh(random, kind, columns);
    }
}

}  // namespace tinsmith::test
