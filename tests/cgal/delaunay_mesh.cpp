// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/delaunay_mesh.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace tinsmith::cgal {

core::MeshData delaunay_mesh(const std::vector<core::Point3>& points) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>> made;
    core::MeshData mesh;
    mesh.vertices = points;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        made.insert({points[i].x, points[i].y})->info() = i;
    for (const auto face : made.finite_face_handles())
        mesh.triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return mesh;
}

}  // namespace tinsmith::cgal
