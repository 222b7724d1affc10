// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/crossings.hpp"

#include <algorithm>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>

#include "core/types/ulp.hpp"

namespace tinsmith::cgal {

using core::Point2;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Exact_rational;

/// Boxes are wider than any distance that rounding makes.
constexpr double kBoxMarginUlps = 128.0;

int side(Point2 a, Point2 b, Point2 c) {
    return CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y),
                             Kernel::Point_2(c.x, c.y));
}

bool is_less(Point2 p, Point2 q) {
    return p.x != q.x ? p.x < q.x : p.y < q.y;
}

std::vector<Box> boxes_of(const std::vector<Line>& lines, double margin) {
    std::vector<Box> boxes;
    for (const Line& line : lines)
        boxes.push_back(Box::around(line.a, line.b, margin));
    return boxes;
}

std::vector<std::array<std::uint32_t, 2>> edges_of(const core::MeshData& mesh) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
            edges.push_back({a, b});
        }
    }
    std::ranges::sort(edges);
    edges.erase(std::ranges::unique(edges).begin(), edges.end());
    return edges;
}

std::vector<Line> lines_of(const core::MeshData& mesh,
                           const std::vector<std::array<std::uint32_t, 2>>& edges) {
    std::vector<Line> lines;
    for (const auto& [a, b] : edges)
        lines.push_back({mesh.vertices[a].plan(), mesh.vertices[b].plan()});
    return lines;
}

double ulp_of(const core::MeshData& mesh) {
    double largest = 0.0;
    for (const core::Point3& v : mesh.vertices)
        largest = std::max({largest, std::fabs(v.x), std::fabs(v.y)});
    return core::ulp(largest);
}

}  // namespace

std::vector<Line> segments_of(const core::Shape& shape) {
    std::vector<Line> segments;
    for (const core::Path& path : shape.paths) {
        const std::size_t count = path.points.size();
        for (std::size_t i = 0; i + (path.closed ? 0 : 1) < count; ++i) {
            const Line line{path.points[i], path.points[(i + 1) % count]};
            if (line.a != line.b) segments.push_back(line);
        }
    }
    return segments;
}

Meeting meeting(const Line& one, const Line& other) {
    const int a = side(one.a, one.b, other.a), b = side(one.a, one.b, other.b);
    const int c = side(other.a, other.b, one.a), d = side(other.a, other.b, one.b);
    if (a * b < 0 && c * d < 0) return Meeting::Cross;
    const auto is_between = [](const Line& line, Point2 p) {  // p is on the line through it
        const Point2 low = is_less(line.a, line.b) ? line.a : line.b;
        const Point2 high = is_less(line.a, line.b) ? line.b : line.a;
        return !is_less(p, low) && !is_less(high, p);
    };
    const bool touch = (a == 0 && is_between(one, other.a)) ||
                       (b == 0 && is_between(one, other.b)) ||
                       (c == 0 && is_between(other, one.a)) || (d == 0 && is_between(other, one.b));
    return touch ? Meeting::Touch : Meeting::Apart;
}

bool is_within(Point2 p, const Line& line, double distance) {
    const Rational dx = Rational(line.b.x) - Rational(line.a.x);
    const Rational dy = Rational(line.b.y) - Rational(line.a.y);
    const Rational px = Rational(p.x) - Rational(line.a.x);
    const Rational py = Rational(p.y) - Rational(line.a.y);
    const Rational ahead = px * dx + py * dy;
    const Rational length = dx * dx + dy * dy;
    const Rational limit = Rational(distance) * Rational(distance);
    if (ahead <= 0) return px * px + py * py <= limit;
    if (ahead >= length) {
        const Rational qx = px - dx, qy = py - dy;
        return qx * qx + qy * qy <= limit;
    }
    const Rational area = dx * py - dy * px;
    return area * area <= limit * length;
}

CrossingOracle::CrossingOracle(const core::MeshData& mesh, const core::Shape& shape)
    : segments_(segments_of(shape)),
      edge_ends_(edges_of(mesh)),
      ulp_(ulp_of(mesh)),
      segment_grid_(boxes_of(segments_, kBoxMarginUlps * ulp_)),
      edge_grid_(boxes_of(lines_of(mesh, edge_ends_), kBoxMarginUlps * ulp_)) {
    edges_ = lines_of(mesh, edge_ends_);
    for (const core::Point3& v : mesh.vertices)
        known_.push_back(v.plan());
    for (const core::Path& path : shape.paths)
        known_.insert(known_.end(), path.points.begin(), path.points.end());
    std::ranges::sort(known_, is_less);
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
        const Box box = Box::around(segments_[s].a, segments_[s].b, 0.0);
        for (const std::uint32_t e : edge_grid_.near(box))
            if (meeting(segments_[s], edges_[e]) == Meeting::Cross) exact_.edges.insert({s, e});
        for (const std::uint32_t t : segment_grid_.near(box))
            if (t > s && meeting(segments_[s], segments_[t]) == Meeting::Cross)
                exact_.self.insert({s, t});
    }
}

std::string CrossingOracle::edge_name(std::uint32_t i) const {
    return std::to_string(edge_ends_[i][0]) + "-" + std::to_string(edge_ends_[i][1]);
}

std::vector<std::uint32_t> CrossingOracle::lines_near(const std::vector<Line>& lines,
                                                      const BoxGrid& grid, Point2 p,
                                                      double near) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : grid.near(Box::around(p, p, 0.0))) {
        const Box box = Box::around(lines[i].a, lines[i].b, kBoxMarginUlps * ulp_);
        if (p.x < box.low.x || p.x > box.high.x || p.y < box.low.y || p.y > box.high.y) continue;
        if (is_within(p, lines[i], near)) found.push_back(i);
    }
    return found;
}

Crossings CrossingOracle::of_vertices(const std::vector<Point2>& vertices, double near) const {
    Crossings found;
    for (const Point2 p : vertices) {
        if (std::ranges::binary_search(known_, p, is_less)) continue;
        const auto segments = lines_near(segments_, segment_grid_, p, near);
        const auto edges = lines_near(edges_, edge_grid_, p, near);
        bool proper = false;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            for (const std::uint32_t e : edges) {
                if (!exact_.edges.contains({segments[i], e})) continue;
                found.edges.insert({segments[i], e});
                proper = true;
            }
            for (std::size_t j = i + 1; j < segments.size(); ++j) {
                if (!exact_.self.contains({segments[i], segments[j]})) continue;
                found.self.insert({segments[i], segments[j]});
                proper = true;
            }
        }
        if (proper) continue;
        for (const std::uint32_t s : segments)
            for (const std::uint32_t e : edges)
                found.edges.insert({s, e});
        if (segments.empty() || edges.empty()) found.unexplained.push_back(p);
    }
    return found;
}

std::string CrossingOracle::excuse(const Crossing& crossing) const {
    const Line& s = segments_[crossing.segment];
    const Line& e = edges_[crossing.other];
    const double near = 2.0 * ulp_;
    if (is_within(e.a, s, near) || is_within(e.b, s, near)) return "edge-end";
    if (is_within(s.a, e, near) || is_within(s.b, e, near)) return "segment-end";
    return "none";
}

}  // namespace tinsmith::cgal
