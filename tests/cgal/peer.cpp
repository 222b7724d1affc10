// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/peer.hpp"

#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_xy_3.h>
#include <CGAL/version.h>

#include "tests/cgal/hull_filling.hpp"

namespace tinsmith::cgal {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Stock = CGAL::Projection_traits_xy_3<Kernel>;

template <typename Variant>
const Kernel::Point_2* point_of(const Variant& met) {
#if CGAL_VERSION_NR >= 1060000000
    return std::get_if<Kernel::Point_2>(&met);
#else
    return boost::get<Kernel::Point_2>(&met);
#endif
}

/// CGAL's own intersection in plan, with the elevation of the second segment, which CGAL gives as
/// the edge that is there already.
struct IntersectOnEdge : Stock::Intersect_2 {
    using Result = decltype(std::declval<Stock::Intersect_2>()(std::declval<Kernel::Segment_3>(),
                                                               std::declval<Kernel::Segment_3>()));

    Result operator()(const Kernel::Segment_3& s, const Kernel::Segment_3& edge) const {
        const Kernel::Point_2 a = project(edge.source()), b = project(edge.target());
        const auto met = CGAL::intersection(
            Kernel::Segment_2(project(s.source()), project(s.target())), Kernel::Segment_2(a, b));
        if (!met) return {};
        const Kernel::Point_2* p = point_of(*met);
        if (p == nullptr) return Stock::Intersect_2::operator()(s, edge);
        const double rise = edge.target().z() - edge.source().z();
        return Result(Kernel::Point_3(p->x(), p->y(), edge.source().z() + alpha(*p, a, b) * rise));
    }
};

struct Traits : Stock {
    using Intersect_2 = IntersectOnEdge;
    Intersect_2 intersect_2_object() const { return {}; }
};

using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Traits, CGAL::Default, CGAL::Exact_predicates_tag>;

/// CGAL numbers a side by the corner across from it.
int side_of(std::uint32_t corner) {
    return static_cast<int>((corner + 2) % 3);
}

/// Makes the triangles the whole content of an empty triangulation. Requires: they are convex
/// together; those from `mesh_size` on are not the mesh's, so that their edges are free.
void load(Delaunay& delaunay, std::span<const core::Point3> points,
          std::span<const Triple> triangles, const Matching& matching, std::size_t mesh_size) {
    auto& tds = delaunay.tds();
    tds.clear();
    const Delaunay::Vertex_handle infinite = tds.create_vertex();
    delaunay.set_infinite_vertex(infinite);
    tds.set_dimension(2);
    std::vector<Delaunay::Vertex_handle> vertices;
    vertices.reserve(points.size());
    for (const core::Point3& p : points) {
        vertices.push_back(tds.create_vertex());
        vertices.back()->set_point({p.x, p.y, p.z});
    }
    std::vector<Delaunay::Face_handle> faces;
    faces.reserve(triangles.size());
    for (const Triple& t : triangles) {
        faces.push_back(tds.create_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
        for (const std::uint32_t v : t)
            vertices[v]->set_face(faces.back());
    }
    for (const auto& [one, other] : matching.pairs) {
        const auto f = faces[one.triangle], g = faces[other.triangle];
        f->set_neighbor(side_of(one.corner), g);
        g->set_neighbor(side_of(other.corner), f);
        const bool in_mesh = one.triangle < mesh_size || other.triangle < mesh_size;
        f->set_constraint(side_of(one.corner), in_mesh);
        g->set_constraint(side_of(other.corner), in_mesh);
    }
    // Hull edge u -> v has the infinite face (v, u, infinite) on its right.
    std::vector<Delaunay::Face_handle> leaving(points.size());
    for (const HalfEdge& side : matching.open) {
        const Triple& t = triangles[side.triangle];
        const std::uint32_t u = t[side.corner], v = t[(side.corner + 1) % 3];
        const auto f = faces[side.triangle];
        const bool in_mesh = side.triangle < mesh_size;
        leaving[u] = tds.create_face(vertices[v], vertices[u], infinite);
        leaving[u]->set_neighbor(2, f);
        leaving[u]->set_constraint(2, in_mesh);
        f->set_neighbor(side_of(side.corner), leaving[u]);
        f->set_constraint(side_of(side.corner), in_mesh);
        infinite->set_face(leaving[u]);
    }
    for (const HalfEdge& side : matching.open) {
        const Triple& t = triangles[side.triangle];
        const auto before = leaving[t[side.corner]];
        const auto after = leaving[t[(side.corner + 1) % 3]];
        before->set_neighbor(1, after);
        after->set_neighbor(0, before);
    }
}

}  // namespace

struct Peer::Triangulation {
    Delaunay delaunay;
};

Peer::Peer(std::unique_ptr<Triangulation> triangulation)
    : triangulation_(std::move(triangulation)) {}
Peer::Peer(const Peer& other)
    : triangulation_(std::make_unique<Triangulation>(*other.triangulation_)) {}
Peer::Peer(Peer&&) noexcept = default;
Peer::~Peer() = default;

Peer Peer::of_points(const core::MeshData& mesh) {
    std::vector<Kernel::Point_3> points;
    points.reserve(mesh.vertices.size());
    for (const core::Point3& v : mesh.vertices)
        points.emplace_back(v.x, v.y, v.z);
    auto made = std::make_unique<Triangulation>();
    made->delaunay.insert(points.begin(), points.end());
    return Peer(std::move(made));
}

Peer Peer::of_triangles(const core::MeshData& mesh) {
    std::vector<Triple> triangles = mesh.triangles;
    Matching matching = match_sides(triangles, 0, {});
    const std::vector<Triple> filling = fill_hull(mesh, matching.open);
    triangles.insert(triangles.end(), filling.begin(), filling.end());
    Matching rest = match_sides(triangles, mesh.triangles.size(), matching.open);
    matching.pairs.insert(matching.pairs.end(), rest.pairs.begin(), rest.pairs.end());
    matching.open = std::move(rest.open);
    auto made = std::make_unique<Triangulation>();
    load(made->delaunay, mesh.vertices, triangles, matching, mesh.triangles.size());
    return Peer(std::move(made));
}

void Peer::insert(std::span<const Polyline> paths) {
    Delaunay& delaunay = triangulation_->delaunay;
    Delaunay::Face_handle near = delaunay.finite_faces_begin();
    for (const Polyline& path : paths) {
        Delaunay::Vertex_handle before;
        for (const core::Point3& p : path) {
            const Delaunay::Vertex_handle v = delaunay.insert({p.x, p.y, p.z}, near);
            if (before != nullptr && before != v) delaunay.insert_constraint(before, v);
            near = v->face();
            before = v;
        }
    }
}

std::size_t Peer::vertex_count() const {
    return triangulation_->delaunay.number_of_vertices();
}

std::vector<core::Point3> Peer::vertices() const {
    std::vector<core::Point3> found;
    for (const auto v : triangulation_->delaunay.finite_vertex_handles())
        found.push_back({v->point().x(), v->point().y(), v->point().z()});
    return found;
}

bool Peer::is_valid() const {
    return triangulation_->delaunay.is_valid();
}

std::size_t Peer::memory_bytes() const {
    const auto& tds = triangulation_->delaunay.tds();
    return tds.vertices().capacity() * sizeof(Delaunay::Vertex) +
           tds.faces().capacity() * sizeof(Delaunay::Face);
}

}  // namespace tinsmith::cgal
