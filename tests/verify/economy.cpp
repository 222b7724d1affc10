// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

/// A position that is, or calls for, a vertex. What is nearer than `radius` may be one with it.
struct Place {
    /// Actual: a segment crosses a chain or crease as that lay in the mesh before its request.
    enum class Kind { OldVertex, Event, NewVertex, Actual };
    Point2 p;
    Kind kind;
    double radius;
    std::size_t line = SIZE_MAX;   ///< of a crossing: the segment's number
    std::size_t other = SIZE_MAX;  ///< and the other's, where that is a segment too
};

/// An edge of the mesh or a segment, left end first; the same one in either direction is equal.
struct Line {
    Point2 a;
    Point2 b;
    Line(Point2 p, Point2 q) : a(p), b(q) {
        if (b.x < a.x || (b.x == a.x && b.y < a.y)) std::swap(a, b);
    }
    std::array<double, 4> key() const { return {a.x, a.y, b.x, b.y}; }
    bool is_box_near(const Line& other, double slack) const {
        const auto [low, high] = std::minmax(a.y, b.y);
        const auto [other_low, other_high] = std::minmax(other.a.y, other.b.y);
        return a.x <= other.b.x + slack && other.a.x <= b.x + slack && low <= other_high + slack &&
               other_low <= high + slack;
    }
};

/// Each once, by the x of the left end.
void sort_out(std::vector<Line>& lines) {
    std::sort(lines.begin(), lines.end(),
              [](const Line& l, const Line& r) { return l.key() < r.key(); });
    lines.erase(std::unique(lines.begin(), lines.end(),
                            [](const Line& l, const Line& r) { return l.key() == r.key(); }),
                lines.end());
}

/// The place where two lines cross. Where they are almost parallel rounding moves it along them:
/// the radius says how far.
Place crossing(const Line& s, const Line& e, double reach) {
    const double sx = s.b.x - s.a.x, sy = s.b.y - s.a.y;
    const double ex = e.b.x - e.a.x, ey = e.b.y - e.a.y;
    const double sine = std::fabs(doubled_area({0, 0}, {sx, sy}, {ex, ey})) /
                        (std::hypot(sx, sy) * std::hypot(ex, ey));
    return {crossing_point(s.a, s.b, e.a, e.b), Place::Kind::Event, reach / sine};
}

/// Where a snap distance moved the way off its segment it crosses lines that the segment only comes
/// near: the place where it comes nearest, within `snap`.
void add_nearest(const Line& s, const Line& e, double reach, double snap,
                 std::vector<Place>& places) {
    const std::array<std::pair<Point2, const Line*>, 4> ends{
        {{s.a, &e}, {s.b, &e}, {e.a, &s}, {e.b, &s}}};
    double least = snap;
    Place nearest = crossing(s, e, reach);
    bool found = false;
    for (const auto& [p, line] : ends) {
        const double distance = line->a == line->b ? std::hypot(p.x - line->a.x, p.y - line->a.y)
                                                   : distance_to(p, line->a, line->b);
        if (distance > least) continue;
        least = distance;
        nearest.p = p;
        found = true;
    }
    if (found) places.push_back(nearest);
}

/// `snap`: zero where the way is that of the segments to within rounding.
void add_crossings(const std::vector<Line>& segments, const Snapshot& origin, double reach,
                   double snap, std::vector<Place>& places) {
    std::vector<Line> edges;
    edges.reserve(origin.data.triangles.size() * 2);
    for (const auto& t : origin.data.triangles)
        for (unsigned i = 0; i < 3; ++i)
            if (t[i] < t[(i + 1) % 3] || origin.stars.triangle_of(t[(i + 1) % 3], t[i]) == kNone)
                edges.emplace_back(origin.data.vertices[t[i]].plan(),
                                   origin.data.vertices[t[(i + 1) % 3]].plan());
    std::sort(edges.begin(), edges.end(),
              [](const Line& l, const Line& r) { return l.a.x < r.a.x; });
    double longest = 0.0;
    for (const Line& e : edges)
        longest = std::max(longest, e.b.x - e.a.x);
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const Line& s = segments[k];
        auto e = std::lower_bound(edges.begin(), edges.end(), s.a.x - longest - snap,
                                  [](const Line& l, double x) { return l.a.x < x; });
        for (; e != edges.end() && e->a.x <= s.b.x + snap; ++e) {
            if (!s.is_box_near(*e, snap)) continue;
            const std::size_t first = places.size();
            if (cross_properly(s.a, s.b, e->a, e->b))
                places.push_back(crossing(s, *e, reach));
            else if (snap > 0.0)
                add_nearest(s, *e, reach, snap, places);
            for (std::size_t i = first; i < places.size(); ++i)
                places[i].line = k;
        }
        for (std::size_t m = k + 1; m < segments.size() && segments[m].a.x <= s.b.x + snap; ++m) {
            const Line& other = segments[m];
            if (!s.is_box_near(other, snap)) continue;
            const std::size_t first = places.size();
            if (cross_properly(s.a, s.b, other.a, other.b)) {
                const Place place = crossing(s, other, reach);
                if (origin.grid.holds(place.p, place.radius)) places.push_back(place);
            } else if (snap > 0.0) {
                add_nearest(s, other, reach, snap, places);
            }
            for (std::size_t i = first; i < places.size(); ++i) {
                places[i].line = k;
                places[i].other = m;
            }
        }
    }
}

/// Groups of places that may be one position, as runs of `order`.
class Clusters {
  public:
    explicit Clusters(std::vector<Place>& places) : places_(places), taken_(places.size(), false) {
        std::sort(places.begin(), places.end(), [](const Place& l, const Place& r) {
            return l.p.x != r.p.x ? l.p.x < r.p.x : l.p.y < r.p.y;
        });
        for (const Place& place : places)
            widest_ = std::max(widest_, place.radius);
    }

    /// The places near the first that is in no cluster yet, and all near those; empty at the end.
    const std::vector<std::size_t>& next() {
        cluster_.clear();
        while (at_ < places_.size() &&
               (taken_[at_] || places_[at_].kind == Place::Kind::OldVertex || is_actual(at_)))
            ++at_;
        if (at_ == places_.size()) return cluster_;
        take(at_);
        for (std::size_t k = 0; k < cluster_.size(); ++k) {
            const std::size_t here = cluster_[k];
            if (is_actual(here)) continue;  // counts where it is, and joins nothing
            const double x = places_[here].p.x;
            for (std::size_t j = here; j-- > 0 && places_[j].p.x >= x - widest_;)
                visit(here, j);
            for (std::size_t j = here + 1; j < places_.size() && places_[j].p.x <= x + widest_; ++j)
                visit(here, j);
        }
        return cluster_;
    }

  private:
    bool is_actual(std::size_t i) const { return places_[i].kind == Place::Kind::Actual; }
    void take(std::size_t i) {
        taken_[i] = true;
        cluster_.push_back(i);
    }
    void visit(std::size_t here, std::size_t j) {
        if (taken_[j]) return;
        const Place &l = places_[here], &r = places_[j];
        const double radius = std::max(l.radius, r.radius);
        const double dx = r.p.x - l.p.x, dy = r.p.y - l.p.y;
        if (std::fabs(dx) <= radius && std::fabs(dy) <= radius && std::hypot(dx, dy) <= radius)
            take(j);
    }

    std::vector<Place>& places_;
    std::vector<bool> taken_;
    double widest_ = 0.0;
    std::size_t at_ = 0;
    std::vector<std::size_t> cluster_;
};

/// How often segments cross chains and creases in the cluster beyond what they cross there by the
/// input alone: where rounding or a snap bent a chain, or left the way back beside the way there,
/// it is crossed more often than its segment; where rounding bent a facet, so is the crease.
std::size_t count_bent(const std::vector<Place>& places, const std::vector<std::size_t>& cluster) {
    std::map<std::size_t, std::pair<std::size_t, std::size_t>> of_line;  // actual, by the input
    for (const std::size_t i : cluster) {
        const Place& place = places[i];
        if (place.kind == Place::Kind::Actual) ++of_line[place.line].first;
        if (place.kind != Place::Kind::Event || place.line == SIZE_MAX) continue;
        ++of_line[place.line].second;
        if (place.other != SIZE_MAX) ++of_line[place.other].second;
    }
    std::size_t found = 0;
    for (const auto& [line, counts] : of_line)
        found += counts.first - std::min(counts.first, counts.second);
    return found;
}

/// How far apart two surfaces over the four points are where only one takes the edge a-b: at the
/// point that lies in the convex hulls of both parts into which Radon's theorem parts them.
double bend_at(Point3 a, Point3 b, Point3 c, Point3 d) {
    const std::array<std::pair<double, double>, 4> shares{
        {{doubled_area(b.plan(), c.plan(), d.plan()), a.z},
         {-doubled_area(a.plan(), c.plan(), d.plan()), b.z},
         {doubled_area(a.plan(), b.plan(), d.plan()), c.z},
         {-doubled_area(a.plan(), b.plan(), c.plan()), d.z}}};
    double positive = 0.0, gap = 0.0;
    for (const auto& [share, z] : shares) {
        positive += std::max(share, 0.0);
        gap += share * z;
    }
    return positive > 0.0 ? std::fabs(gap) / positive : 0.0;
}

/// Edges along which the surface ends, or bends by more than `flat`.
void add_creases(const Snapshot& mesh, double flat, std::vector<Line>& lines) {
    const auto& at = mesh.data.vertices;
    const auto corner = [&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
        for (const std::uint32_t v : mesh.data.triangles[t])
            if (v != a && v != b) return at[v];
        return at[a];
    };
    for (std::uint32_t t = 0; t < mesh.data.triangles.size(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.data.triangles[t][i];
            const std::uint32_t b = mesh.data.triangles[t][(i + 1) % 3];
            const std::uint32_t twin = mesh.stars.triangle_of(b, a);
            if (twin != kNone && b < a) continue;
            if (twin == kNone || bend_at(at[a], at[b], corner(t, a, b), corner(twin, a, b)) > flat)
                lines.emplace_back(at[a].plan(), at[b].plan());
        }
    }
}

}  // namespace

void add_actual_crossings(const Snapshot& before, std::span<const core::Shape> shapes, double flat,
                          std::vector<ActualCrossing>& crossings) {
    std::vector<Line> constraints;
    for (const auto& [v, w] : before.data.constraints)
        constraints.emplace_back(before.data.vertices[v].plan(), before.data.vertices[w].plan());
    add_creases(before, flat, constraints);
    double longest = 0.0;
    for (const Line& line : constraints)
        longest = std::max(longest, line.b.x - line.a.x);
    sort_out(constraints);
    std::vector<Line> segments;
    for (const Segment& s : segments_of(shapes))
        segments.emplace_back(s.a, s.b);
    sort_out(segments);
    for (const Line& s : segments) {
        auto c = std::lower_bound(constraints.begin(), constraints.end(), s.a.x - longest,
                                  [](const Line& l, double x) { return l.a.x < x; });
        for (; c != constraints.end() && c->a.x <= s.b.x; ++c)
            if (s.is_box_near(*c, 0.0) && cross_properly(s.a, s.b, c->a, c->b))
                crossings.push_back({s.a, s.b, crossing_point(s.a, s.b, c->a, c->b)});
    }
}

Faults check_economy(const Snapshot& origin, const core::MeshData& after,
                     std::span<const core::Shape> shapes, std::span<const ActualCrossing> crossings,
                     double reach, double snap, std::size_t forced) {
    std::vector<Place> places;
    std::vector<Line> points, segments;
    for (const auto& shape : shapes)
        for (const auto& path : shape.paths)
            for (const Point2 p : path.points)
                points.emplace_back(p, p);
    sort_out(points);
    for (const Line& p : points)
        if (origin.grid.holds(p.a, reach)) places.push_back({p.a, Place::Kind::Event, reach});
    for (const Segment& s : segments_of(shapes))
        segments.emplace_back(s.a, s.b);
    sort_out(segments);
    add_crossings(segments, origin, reach, snap, places);
    for (const ActualCrossing& actual : crossings) {
        const auto line =
            std::lower_bound(segments.begin(), segments.end(), Line(actual.a, actual.b),
                             [](const Line& l, const Line& r) { return l.key() < r.key(); });
        places.push_back({actual.p, Place::Kind::Actual, reach,
                          static_cast<std::size_t>(line - segments.begin())});
    }
    for (std::size_t v = 0; v < after.vertices.size(); ++v)
        places.push_back(
            {after.vertices[v].plan(),
             v < origin.data.vertices.size() ? Place::Kind::OldVertex : Place::Kind::NewVertex,
             reach});
    Faults faults;
    Clusters clusters(places);
    for (;;) {
        const auto& cluster = clusters.next();
        if (cluster.empty()) return faults;
        std::size_t old = 0, events = 0, added = 0;
        for (const std::size_t i : cluster) {
            old += places[i].kind == Place::Kind::OldVertex;
            events += places[i].kind == Place::Kind::Event;
            added += places[i].kind == Place::Kind::NewVertex;
        }
        if (added > events + forced) events += count_bent(places, cluster);
        if (added > events + forced)
            faults.push_back(words("G8 at ", places[cluster[0]].p.x, " ", places[cluster[0]].p.y,
                                   ": ", events, " reasons, ", old, " old and ", added,
                                   " new vertices"));
    }
}

}  // namespace tinsmith::verify
