// SPDX-License-Identifier: Apache-2.0
#include "tests/support/guarantees.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <utility>

#include "core/mesh/check.hpp"
#include "tests/support/quad.hpp"

namespace tinsmith::test {

using core::Point2;

namespace {

struct Segment {
    Point2 a;
    Point2 b;
};

std::vector<Segment> segments_of(std::span<const core::Shape> shapes) {
    std::vector<Segment> found;
    for (const auto& shape : shapes) {
        for (const auto& path : shape.paths) {
            const std::size_t n = path.points.size();
            for (std::size_t i = 1; i < n + (path.closed ? 1 : 0); ++i)
                if (path.points[i - 1] != path.points[i % n])
                    found.push_back({path.points[i - 1], path.points[i % n]});
        }
    }
    return found;
}

double distance_to_line(Point2 p, const Segment& s) {
    return std::fabs(static_cast<double>(area(s.a, s.b, p))) /
           std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
}

/// Position along the segment, 0 at a, in plan units.
double along(Point2 p, const Segment& s) {
    const Quad dx = Quad(s.b.x) - Quad(s.a.x), dy = Quad(s.b.y) - Quad(s.a.y);
    const Quad dot = (Quad(p.x) - Quad(s.a.x)) * dx + (Quad(p.y) - Quad(s.a.y)) * dy;
    return static_cast<double>(dot / Quad(std::hypot(s.b.x - s.a.x, s.b.y - s.a.y)));
}

template <typename... T>
std::string words(const T&... parts) {
    std::ostringstream out;
    out.precision(17);
    (out << ... << parts);
    return out.str();
}

}  // namespace

double rounding_reach(const SurfaceOracle& mesh) {
    double largest = 0.0;
    for (const double c : {mesh.min().x, mesh.min().y, mesh.max().x, mesh.max().y})
        largest = std::max(largest, std::fabs(c));
    return 4.0 * (std::nextafter(largest, HUGE_VAL) - largest);
}

std::vector<std::string> check_valid(const core::Tin& tin) {
    std::vector<std::string> broken;
    for (const auto& violation : core::check_tin(tin))
        broken.push_back("G1 " + violation.law + ": " + violation.detail);
    return broken;
}

std::vector<std::string> check_shape_kept(const Operation& op, std::size_t samples,
                                          std::uint64_t seed) {
    std::vector<std::string> broken;
    const SurfaceOracle after(op.after.to_data());
    const SurfaceOracle& before = op.before;
    const double extent =
        std::hypot(before.max().x - before.min().x, before.max().y - before.min().y);
    const double reach = rounding_reach(before);
    double steepest = 0.0;  // of the triangles touched
    const auto& old_triangles = before.mesh().triangles;
    for (std::uint32_t t = 0; t < old_triangles.size(); ++t)
        if (after.mesh().triangles[t] != old_triangles[t])
            steepest = std::max(steepest, before.slope(t));
    double certified = 0.0;
    for (const auto& shape : op.report.shapes)
        certified += shape.max_vertical_deviation;
    const auto compare = [&](Point2 p, const char* what) {
        const auto t = before.triangle_at(p, reach);
        const auto u = after.triangle_at(p, reach);
        if (t.has_value() != u.has_value()) {
            // Within rounding of the outline one of the two may just miss.
            if (before.triangle_at(p, 8 * reach) && after.triangle_at(p, 8 * reach)) return;
            broken.push_back(words("G2 ", what, " at ", p.x, " ", p.y, " is on one surface only"));
            return;
        }
        if (!t) return;
        const double difference = std::fabs(before.elevation(*t, p) - after.elevation(*u, p));
        const double slope = std::max(before.slope(*t), steepest);
        // A sample within rounding of an edge may take either triangle's plane there.
        if (difference > 1e-9 * extent + reach * slope)
            broken.push_back(words("G2 ", what, " at ", p.x, " ", p.y, " is off by ", difference));
        if (difference >
            certified + 16 * reach * slope + 1e-12 * std::fabs(before.elevation(*t, p)))
            broken.push_back(words("G2 ", what, " at ", p.x, " ", p.y, " is off by ", difference,
                                   ", more than the certified ", certified));
    };
    for (const auto& v : before.mesh().vertices)
        compare(v.plan(), "old vertex");
    for (std::size_t v = before.mesh().vertices.size(); v < after.mesh().vertices.size(); ++v) {
        const auto& vertex = after.mesh().vertices[v];
        compare(vertex.plan(), "new vertex");
        const auto t = before.triangle_at(vertex.plan(), 8 * reach);
        if (t && std::fabs(before.elevation(*t, vertex.plan()) - vertex.z) >
                     1e-9 * extent + reach * std::max(before.slope(*t), steepest))
            broken.push_back(words("G2 new vertex ", v, " is not on the old surface"));
    }
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(before.min().x, before.max().x);
    std::uniform_real_distribution<double> y(before.min().y, before.max().y);
    for (std::size_t i = 0; i < samples; ++i) {
        const double px = x(random);
        compare({px, y(random)}, "sample");
    }
    return broken;
}

std::vector<std::string> check_integrated(const Operation& op) {
    std::vector<std::string> broken;
    const core::MeshData mesh = op.after.to_data();
    const double reach = rounding_reach(op.before);
    // Constrained edges by the x of their left end, so that a segment looks at few of them.
    struct Constraint {
        Point2 a, b;
    };
    std::vector<Constraint> constraints;
    double longest = 0.0;
    for (const auto& [i, j] : mesh.constraints) {
        Point2 a = mesh.vertices[i].plan(), b = mesh.vertices[j].plan();
        if (b.x < a.x) std::swap(a, b);
        constraints.push_back({a, b});
        longest = std::max(longest, b.x - a.x);
    }
    std::sort(constraints.begin(), constraints.end(),
              [](const Constraint& l, const Constraint& r) { return l.a.x < r.a.x; });
    for (const Segment& s : segments_of(op.shapes)) {
        const double length = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
        const double low = std::min(s.a.x, s.b.x) - longest - reach;
        const double high = std::max(s.a.x, s.b.x) + reach;
        std::vector<std::pair<double, double>> covered;
        auto c = std::lower_bound(constraints.begin(), constraints.end(), low,
                                  [](const Constraint& l, double x) { return l.a.x < x; });
        for (; c != constraints.end() && c->a.x <= high; ++c) {
            if (distance_to_line(c->a, s) > reach || distance_to_line(c->b, s) > reach) continue;
            const auto [from, to] = std::minmax({along(c->a, s), along(c->b, s)});
            if (to < -reach || from > length + reach) continue;
            covered.emplace_back(from, to);
        }
        std::sort(covered.begin(), covered.end());
        double done = 0.0;
        covered.emplace_back(length, length);
        for (const auto& [from, to] : covered) {
            if (from > done + 2 * reach) {
                // A gap: right only where the segment is outside the mesh.
                for (const double share : {0.02, 0.5, 0.98}) {
                    const double at = (done + (from - done) * share) / length;
                    const Point2 p{s.a.x + (s.b.x - s.a.x) * at, s.a.y + (s.b.y - s.a.y) * at};
                    if (op.before.triangle_at(p, -2 * reach))
                        broken.push_back(words("G3 segment from ", s.a.x, " ", s.a.y, " to ", s.b.x,
                                               " ", s.b.y, " is not covered at ", p.x, " ", p.y));
                }
            }
            done = std::max(done, to);
        }
    }
    return broken;
}

namespace {

/// A position that is, or calls for, a vertex. What is nearer than `radius` may be one with it.
struct Place {
    enum class Kind { OldVertex, Event, NewVertex };
    Point2 p;
    Kind kind;
    double radius;
};

/// Proper crossings of the segments with the mesh's edges and with each other, on the mesh. Where
/// two lines are almost parallel rounding moves their crossing along them: the radius says so.
void add_crossings(const std::vector<Segment>& segments, const SurfaceOracle& before, double reach,
                   std::vector<Place>& places) {
    const core::MeshData& mesh = before.mesh();
    std::vector<Segment> edges;
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (const auto& t : mesh.triangles)
        for (unsigned i = 0; i < 3; ++i)
            if (seen.insert(std::minmax({t[i], t[(i + 1) % 3]})).second)
                edges.push_back({mesh.vertices[t[i]].plan(), mesh.vertices[t[(i + 1) % 3]].plan()});
    const std::size_t mesh_edges = edges.size();
    edges.insert(edges.end(), segments.begin(), segments.end());
    std::vector<std::uint32_t> by_x(edges.size());
    double longest = 0.0;
    for (std::uint32_t i = 0; i < by_x.size(); ++i) {
        by_x[i] = i;
        longest = std::max(longest, std::fabs(edges[i].a.x - edges[i].b.x));
    }
    const auto left = [&](std::uint32_t i) { return std::min(edges[i].a.x, edges[i].b.x); };
    std::sort(by_x.begin(), by_x.end(), [&](auto l, auto r) { return left(l) < left(r); });
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const Segment& s = segments[k];
        const auto [low, high] = std::minmax({s.a.x, s.b.x});
        auto at = std::lower_bound(by_x.begin(), by_x.end(), low - longest,
                                   [&](std::uint32_t i, double x) { return left(i) < x; });
        for (; at != by_x.end() && left(*at) <= high; ++at) {
            if (*at >= mesh_edges && *at - mesh_edges <= k) continue;  // each pair once
            const Segment& e = edges[*at];
            const Quad ea = area(s.a, s.b, e.a), eb = area(s.a, s.b, e.b);
            if (sign(ea) * sign(eb) >= 0) continue;
            if (sign(area(e.a, e.b, s.a)) * sign(area(e.a, e.b, s.b)) >= 0) continue;
            const Quad share = ea / (ea - eb);
            const Point2 p{static_cast<double>(Quad(e.a.x) + (Quad(e.b.x) - Quad(e.a.x)) * share),
                           static_cast<double>(Quad(e.a.y) + (Quad(e.b.y) - Quad(e.a.y)) * share)};
            if (*at >= mesh_edges && !before.triangle_at(p, reach)) continue;
            const double sine = static_cast<double>(ea > eb ? ea - eb : eb - ea) /
                                std::hypot(s.b.x - s.a.x, s.b.y - s.a.y) /
                                std::hypot(e.b.x - e.a.x, e.b.y - e.a.y);
            places.push_back({p, Place::Kind::Event, reach / sine});
        }
    }
}

/// Groups of places that may be one position.
std::vector<std::vector<std::size_t>> clusters_of(std::vector<Place>& places) {
    std::sort(places.begin(), places.end(), [](const Place& l, const Place& r) {
        return l.p.x != r.p.x ? l.p.x < r.p.x : l.p.y < r.p.y;
    });
    double widest = 0.0;
    for (const Place& place : places)
        widest = std::max(widest, place.radius);
    std::vector<bool> taken(places.size(), false);
    std::vector<std::vector<std::size_t>> clusters;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (taken[i] || places[i].kind == Place::Kind::OldVertex) continue;
        std::vector<std::size_t> cluster{i};
        taken[i] = true;
        for (std::size_t k = 0; k < cluster.size(); ++k) {
            const Place here = places[cluster[k]];
            const auto visit = [&](std::size_t j) {
                const double distance =
                    std::hypot(places[j].p.x - here.p.x, places[j].p.y - here.p.y);
                if (taken[j] || distance > std::max(here.radius, places[j].radius)) return;
                taken[j] = true;
                cluster.push_back(j);
            };
            for (std::size_t j = cluster[k]; j-- > 0 && places[j].p.x >= here.p.x - widest;)
                visit(j);
            for (std::size_t j = cluster[k] + 1;
                 j < places.size() && places[j].p.x <= here.p.x + widest; ++j)
                visit(j);
        }
        clusters.push_back(std::move(cluster));
    }
    return clusters;
}

}  // namespace

std::vector<std::string> check_economical(const Operation& op, std::size_t forced) {
    const core::MeshData& mesh = op.before.mesh();
    const double reach = 2 * rounding_reach(op.before);
    // The same position or segment, in either direction, counts once however often it is given.
    std::set<std::pair<double, double>> points;
    std::map<std::array<double, 4>, Segment> distinct;
    for (const auto& shape : op.shapes)
        for (const auto& path : shape.paths)
            for (const Point2 p : path.points)
                points.insert({p.x, p.y});
    for (const Segment& s : segments_of(op.shapes)) {
        const bool forward = s.a.x != s.b.x ? s.a.x < s.b.x : s.a.y < s.b.y;
        const Segment t = forward ? s : Segment{s.b, s.a};
        distinct.insert({{t.a.x, t.a.y, t.b.x, t.b.y}, t});
    }
    std::vector<Segment> segments;
    for (const auto& [key, s] : distinct)
        segments.push_back(s);

    std::vector<Place> places;
    for (const auto& [x, y] : points)
        if (op.before.triangle_at({x, y}, reach))
            places.push_back({{x, y}, Place::Kind::Event, reach});
    add_crossings(segments, op.before, reach, places);
    for (const auto& v : mesh.vertices)
        places.push_back({v.plan(), Place::Kind::OldVertex, reach});
    const core::MeshData after = op.after.to_data();
    for (std::size_t v = mesh.vertices.size(); v < after.vertices.size(); ++v)
        places.push_back({after.vertices[v].plan(), Place::Kind::NewVertex, reach});

    std::vector<std::string> broken;
    for (const auto& cluster : clusters_of(places)) {
        std::size_t old = 0, events = 0, added = 0, surely_on_mesh = 0;
        for (const std::size_t i : cluster) {
            old += places[i].kind == Place::Kind::OldVertex;
            events += places[i].kind == Place::Kind::Event;
            added += places[i].kind == Place::Kind::NewVertex;
            surely_on_mesh += places[i].kind == Place::Kind::Event &&
                              op.before.triangle_at(places[i].p, -places[i].radius).has_value();
        }
        // One event alone is one vertex, exactly, unless it is within rounding of the outline.
        // Several that may be one are one at least.
        const bool right = added <= events + forced && (surely_on_mesh == 0 || old + added > 0);
        if (!right)
            broken.push_back(words("G8 at ", places[cluster[0]].p.x, " ", places[cluster[0]].p.y,
                                   ": ", events, " events, ", old, " old and ", added,
                                   " new vertices"));
    }
    return broken;
}

std::vector<std::string> check_guarantees(const Operation& op, std::size_t samples,
                                          std::uint64_t seed) {
    std::vector<std::string> broken = check_valid(op.after);
    const auto add = [&broken](const std::vector<std::string>& more) {
        broken.insert(broken.end(), more.begin(), more.end());
    };
    add(check_shape_kept(op, samples, seed));
    add(check_integrated(op));
    add(check_economical(op, 0));
    return broken;
}

}  // namespace tinsmith::test
