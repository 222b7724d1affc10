// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/facet_delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace tinsmith::cgal {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Exact_rational;

/// The plane rises by p/r for each unit of x and by q/r for each of y.
struct Slope {
    Rational p, q, r;

    explicit Slope(const std::array<core::Point3, 3>& plane) {
        const auto &a = plane[0], &b = plane[1], &c = plane[2];
        const Rational bx = Rational(b.x) - Rational(a.x), by = Rational(b.y) - Rational(a.y);
        const Rational bz = Rational(b.z) - Rational(a.z);
        const Rational cx = Rational(c.x) - Rational(a.x), cy = Rational(c.y) - Rational(a.y);
        const Rational cz = Rational(c.z) - Rational(a.z);
        p = bz * cy - cz * by;
        q = bx * cz - cx * bz;
        r = bx * cy - cx * by;
    }

    /// Squared length in the plane of an offset in plan, times r^2.
    Rational length(const Rational& dx, const Rational& dy) const {
        const Rational rise = p * dx + q * dy;
        return r * r * (dx * dx + dy * dy) + rise * rise;
    }
};

/// Orientations are the plan's; circles are circles of the plane, which are ellipses in plan.
class PlaneTraits : public Kernel {
  public:
    explicit PlaneTraits(const Slope& slope) : slope_(&slope) {}

    struct Side_of_oriented_circle_2 {
        using result_type = CGAL::Oriented_side;
        const Slope* slope;

        result_type operator()(const Kernel::Point_2& a, const Kernel::Point_2& b,
                               const Kernel::Point_2& c, const Kernel::Point_2& d) const {
            std::array<std::array<Rational, 3>, 3> m;
            const std::array<const Kernel::Point_2*, 3> corners{&a, &b, &c};
            for (std::size_t i = 0; i < 3; ++i) {
                m[i][0] = Rational(corners[i]->x()) - Rational(d.x());
                m[i][1] = Rational(corners[i]->y()) - Rational(d.y());
                m[i][2] = slope->length(m[i][0], m[i][1]);
            }
            const Rational determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
            return CGAL::sign(determinant);
        }
    };
    Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const { return {slope_}; }

  private:
    const Slope* slope_;
};

enum class Place : std::uint8_t { Unknown, Outside, Inside };

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, PlaneTraits>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    PlaneTraits, CGAL::Triangulation_face_base_with_info_2<Place, PlaneTraits>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    PlaneTraits, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

/// Faces on the other side of an odd number of outlines, seen from infinity, are inside.
void mark_places(Delaunay& delaunay, const Facet& facet) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> outline;
    for (const auto& [a, b] : facet.outline)
        outline.insert(std::minmax(a, b));
    std::vector<Delaunay::Face_handle> pending{delaunay.infinite_face()};
    pending.back()->info() = Place::Outside;
    while (!pending.empty()) {
        const Delaunay::Face_handle face = pending.back();
        pending.pop_back();
        for (int i = 0; i < 3; ++i) {
            const Delaunay::Face_handle beside = face->neighbor(i);
            if (beside->info() != Place::Unknown) continue;
            const auto a = face->vertex(Delaunay::ccw(i)), b = face->vertex(Delaunay::cw(i));
            const bool crosses = !delaunay.is_infinite(a) && !delaunay.is_infinite(b) &&
                                 outline.contains(std::minmax(a->info(), b->info()));
            const bool outside = (face->info() == Place::Outside) != crosses;
            beside->info() = outside ? Place::Outside : Place::Inside;
            pending.push_back(beside);
        }
    }
}

}  // namespace

std::vector<Triple> constrained_delaunay(const Facet& facet) {
    const Slope slope(facet.plane);
    Delaunay delaunay{PlaneTraits(slope)};
    std::vector<Delaunay::Vertex_handle> handles;
    for (std::uint32_t i = 0; i < facet.points.size(); ++i) {
        handles.push_back(delaunay.insert({facet.points[i].x, facet.points[i].y}));
        handles.back()->info() = i;
    }
    for (const auto& edges : {facet.outline, facet.fixed})
        for (const auto& [a, b] : edges)
            delaunay.insert_constraint(handles[a], handles[b]);
    for (const Delaunay::Face_handle face : delaunay.all_face_handles())
        face->info() = Place::Unknown;
    mark_places(delaunay, facet);
    std::vector<Triple> triangles;
    for (const Delaunay::Face_handle face : delaunay.finite_face_handles()) {
        if (face->info() == Place::Inside)
            triangles.push_back(
                {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return triangles;
}

std::vector<double> smallest_angles(const Facet& facet, const std::vector<Triple>& triangles) {
    const Slope slope(facet.plane);
    const long double rise_x = CGAL::to_double(slope.p / slope.r);
    const long double rise_y = CGAL::to_double(slope.q / slope.r);
    const long double stretch = std::sqrt(1.0L + rise_x * rise_x + rise_y * rise_y);
    std::vector<double> angles;
    for (const Triple& t : triangles) {
        long double smallest = std::numbers::pi_v<long double>;
        for (std::size_t i = 0; i < 3; ++i) {
            const core::Point2 at = facet.points[t[i]];
            const core::Point2 b = facet.points[t[(i + 1) % 3]], c = facet.points[t[(i + 2) % 3]];
            // Differences of doubles in long double: exact but for points far apart in size.
            const long double bx = static_cast<long double>(b.x) - at.x;
            const long double by = static_cast<long double>(b.y) - at.y;
            const long double cx = static_cast<long double>(c.x) - at.x;
            const long double cy = static_cast<long double>(c.y) - at.y;
            const long double dot =
                bx * cx + by * cy + (rise_x * bx + rise_y * by) * (rise_x * cx + rise_y * cy);
            smallest = std::min(smallest, std::atan2(stretch * (bx * cy - by * cx), dot));
        }
        angles.push_back(static_cast<double>(smallest * 180.0L / std::numbers::pi_v<long double>));
    }
    std::ranges::sort(angles);
    return angles;
}

}  // namespace tinsmith::cgal
