// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/guarantees.hpp"
#include "tests/support/same_bytes.hpp"

namespace tinsmith::test {

/// How the cells of a grid are cut in two.
enum class Diagonals { Rising, Falling, Alternate };

/// A rough grid of cells: vertex (c, r) has slot r * (columns + 1) + c, the cell's triangles follow
/// each other, and no two neighbours lie in one plane.
inline core::MeshData grid(unsigned columns, unsigned rows, Diagonals diagonals = Diagonals::Rising,
                           double step = 1.0, core::Point2 origin = {}) {
    core::MeshData mesh;
    for (unsigned r = 0; r <= rows; ++r)
        for (unsigned c = 0; c <= columns; ++c)
            mesh.vertices.push_back({origin.x + c * step, origin.y + r * step,
                                     step * 0.125 * ((c * 7 + r * 13 + c * r * 5) % 11)});
    for (unsigned r = 0; r < rows; ++r) {
        for (unsigned c = 0; c < columns; ++c) {
            const unsigned a = r * (columns + 1) + c, b = a + 1;
            const unsigned d = a + columns + 1, e = d + 1;
            const bool rising = diagonals == Diagonals::Rising ||
                                (diagonals == Diagonals::Alternate && (c + r) % 2 == 0);
            if (rising) {
                mesh.triangles.push_back({a, b, e});
                mesh.triangles.push_back({a, e, d});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, e, d});
            }
        }
    }
    return mesh;
}

/// A grid of 3 x 3 cells without the one in the middle.
inline core::MeshData ring_of_cells(Diagonals diagonals = Diagonals::Rising) {
    core::MeshData mesh = grid(3, 3, diagonals);
    mesh.triangles.erase(mesh.triangles.begin() + 8, mesh.triangles.begin() + 10);
    return mesh;
}

/// One large triangle, on a slope.
inline core::MeshData one_triangle(double size = 100.0) {
    return {{{0, 0, 0}, {size, 0, size / 4}, {0, size, size / 2}}, {{0, 1, 2}}, {}};
}

inline core::Tin built(const core::MeshData& mesh) {
    return std::move(*core::build_tin(mesh));
}

inline core::Shape line(std::vector<core::Point2> points) {
    return {{{std::move(points), false}}};
}

inline core::Shape ring(std::vector<core::Point2> points) {
    return {{{std::move(points), true}}};
}

/// Slots too, not just what `to_data` shows.
inline bool same_slots(const core::Tin& a, const core::Tin& b) {
    if (a.triangle_count() != b.triangle_count() || !same_bytes(a.to_data(), b.to_data()))
        return false;
    for (std::uint32_t t = 0; t < a.triangle_count(); ++t)
        if (!(a.triangle({t}) == b.triangle({t}))) return false;
    for (std::uint32_t v = 0; v < a.vertex_count(); ++v)
        if (a.vertex({v}).triangle != b.vertex({v}).triangle) return false;
    return true;
}

/// What came of integrating shapes and of holding every guarantee against the result.
struct Outcome {
    core::Report report;
    std::string broken;  ///< empty when it worked and all guarantees hold

    const core::ShapeReport& shape(std::size_t i = 0) const { return report.shapes[i]; }
};

/// `fresh`: the mesh was not edited before, so that new vertices can be counted as well.
inline Outcome integrate_checked(core::Tin& tin, const std::vector<core::Shape>& shapes,
                                 const core::IntegrateOptions& options = {}, bool fresh = true) {
    Outcome outcome;
    verify::Verifier verifier(tin.to_data());
    const auto report = core::integrate(tin, shapes, options);
    if (!report) {
        outcome.broken = std::string(core::code_name(report.errors()[0].code)) + ": " +
                         report.errors()[0].detail;
        if (!same_bytes(verifier.mesh(), tin.to_data())) outcome.broken += "; the mesh changed";
        return outcome;
    }
    outcome.report = *report;
    const auto broken =
        check_guarantees(verifier, {shapes, options, *report, tin}, fresh ? 0 : verify::kUncounted);
    for (std::size_t i = 0; i < broken.size() && i < 5; ++i)
        outcome.broken += broken[i] + "\n";
    return outcome;
}

/// Plan positions and elevations of the vertices, in order of position.
inline std::vector<std::pair<std::pair<double, double>, double>> vertex_set(const core::Tin& tin) {
    std::vector<std::pair<std::pair<double, double>, double>> found;
    for (const auto& v : tin.to_data().vertices)
        found.push_back({{v.x, v.y}, v.z});
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace tinsmith::test
