// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/hull_filling.hpp"

#include <algorithm>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace tinsmith::cgal {

namespace {

enum class Place : std::uint8_t { Unknown, Outside, Inside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<Place, Kernel>>;
using Outline = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

/// Faces on the other side of an odd number of outlines, seen from infinity, are the mesh.
void mark_places(Outline& outline) {
    std::vector<Outline::Face_handle> pending{outline.infinite_face()};
    pending.back()->info() = Place::Outside;
    while (!pending.empty()) {
        const Outline::Face_handle face = pending.back();
        pending.pop_back();
        for (int i = 0; i < 3; ++i) {
            const Outline::Face_handle beside = face->neighbor(i);
            if (beside->info() != Place::Unknown) continue;
            const bool outside = (face->info() == Place::Outside) != face->is_constrained(i);
            beside->info() = outside ? Place::Outside : Place::Inside;
            pending.push_back(beside);
        }
    }
}

}  // namespace

Matching match_sides(std::span<const Triple> triangles, std::size_t first,
                     std::span<const HalfEdge> open) {
    struct Keyed {
        std::uint64_t ends;
        HalfEdge side;
    };
    std::vector<Keyed> sides;
    sides.reserve(3 * (triangles.size() - first) + open.size());
    const auto add = [&](HalfEdge side) {
        const auto [a, b] = std::minmax({triangles[side.triangle][side.corner],
                                         triangles[side.triangle][(side.corner + 1) % 3]});
        sides.push_back({std::uint64_t{a} << 32 | b, side});
    };
    for (std::size_t t = first; t < triangles.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i)
            add({static_cast<std::uint32_t>(t), i});
    for (const HalfEdge& side : open)
        add(side);
    std::ranges::sort(sides, {}, &Keyed::ends);
    Matching matching;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i + 1 < sides.size() && sides[i].ends == sides[i + 1].ends) {
            matching.pairs.push_back({sides[i].side, sides[i + 1].side});
            ++i;
        } else {
            matching.open.push_back(sides[i].side);
        }
    }
    return matching;
}

std::vector<Triple> fill_hull(const core::MeshData& mesh, std::span<const HalfEdge> outline) {
    Outline triangulation;
    std::vector<Outline::Vertex_handle> handles(mesh.vertices.size());
    Outline::Face_handle near;
    const auto insert = [&](std::uint32_t v) {
        if (handles[v] == nullptr) {
            handles[v] = triangulation.insert({mesh.vertices[v].x, mesh.vertices[v].y}, near);
            handles[v]->info() = v;
            near = handles[v]->face();
        }
        return handles[v];
    };
    for (const HalfEdge& side : outline) {
        const Triple& t = mesh.triangles[side.triangle];
        const Outline::Vertex_handle a = insert(t[side.corner]);
        triangulation.insert_constraint(a, insert(t[(side.corner + 1) % 3]));
    }
    for (const Outline::Face_handle face : triangulation.all_face_handles())
        face->info() = Place::Unknown;
    mark_places(triangulation);
    std::vector<Triple> filling;
    for (const Outline::Face_handle face : triangulation.finite_face_handles()) {
        if (face->info() == Place::Outside)
            filling.push_back(
                {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return filling;
}

}  // namespace tinsmith::cgal
