// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/delaunay_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace tinsmith::cgal {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Indexed =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

}  // namespace

core::MeshData delaunay_mesh(const std::vector<core::Point3>& points) {
    Indexed made;
    core::MeshData mesh;
    mesh.vertices = points;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        made.insert({points[i].x, points[i].y})->info() = i;
    for (const auto face : made.finite_face_handles())
        mesh.triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return mesh;
}

std::size_t delaunay_count(const std::vector<core::Point3>& points) {
    std::vector<Kernel::Point_2> plan;
    plan.reserve(points.size());
    for (const core::Point3& p : points)
        plan.emplace_back(p.x, p.y);
    CGAL::Delaunay_triangulation_2<Kernel> made;
    made.insert(plan.begin(), plan.end());
    return made.number_of_faces();
}

std::size_t delaunay_count_with_indices(const std::vector<core::Point3>& points) {
    std::vector<std::pair<Kernel::Point_2, std::uint32_t>> plan;
    plan.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        plan.emplace_back(Kernel::Point_2(points[i].x, points[i].y), i);
    Indexed made;
    made.insert(plan.begin(), plan.end());
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(made.number_of_faces());
    for (const auto face : made.finite_face_handles())
        triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return triangles.size();
}

bool is_delaunay(const core::MeshData& mesh) {
    struct Wing {
        std::array<std::uint32_t, 2> edge;
        std::uint32_t apex;
    };
    std::vector<Wing> wings;
    for (const auto& t : mesh.triangles)
        for (unsigned i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            wings.push_back({{std::min(a, b), std::max(a, b)}, t[(i + 2) % 3]});
        }
    std::ranges::sort(wings, {}, &Wing::edge);
    const auto point = [&](std::uint32_t v) {
        return Kernel::Point_2(mesh.vertices[v].x, mesh.vertices[v].y);
    };
    for (std::size_t i = 0; i + 1 < wings.size(); ++i) {
        if (wings[i].edge != wings[i + 1].edge) continue;
        if (CGAL::side_of_bounded_circle(point(wings[i].edge[0]), point(wings[i].edge[1]),
                                         point(wings[i].apex),
                                         point(wings[i + 1].apex)) == CGAL::ON_BOUNDED_SIDE)
            return false;
    }
    return true;
}

}  // namespace tinsmith::cgal
