// SPDX-License-Identifier: Apache-2.0
// The promise that each new vertex has a reason.
#include <algorithm>
#include <cmath>

#include "core/integrate/box_grid.hpp"
#include "core/integrate/distance.hpp"
#include "core/integrate/promise.hpp"

namespace tinsmith::core {

namespace {

/// A new vertex, or a position that calls for one. What is nearer than `radius` may be one with it.
struct Place {
    Point2 p;
    double radius;
    bool is_reason;
};

/// An edge or a segment, left end first; the same one in either direction is equal.
struct Line {
    Point2 a;
    Point2 b;
    Line(Point2 p, Point2 q) : a(p), b(q) {
        if (q.x < p.x || (q.x == p.x && q.y < p.y)) std::swap(a, b);
    }
    friend bool operator==(const Line&, const Line&) = default;
};

bool is_left_of(const Line& l, const Line& r) {
    if (l.a.x != r.a.x) return l.a.x < r.a.x;
    if (l.a.y != r.a.y) return l.a.y < r.a.y;
    return l.b.x != r.b.x ? l.b.x < r.b.x : l.b.y < r.b.y;
}

/// Each once.
void sort_out(std::vector<Line>& lines) {
    std::sort(lines.begin(), lines.end(), is_left_of);
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
}

std::vector<Box> boxes_of(const std::vector<Line>& lines) {
    std::vector<Box> boxes;
    boxes.reserve(lines.size());
    for (const Line& line : lines)
        boxes.push_back(Box::around(line.a, line.b));
    return boxes;
}

class Reasons {
  public:
    explicit Reasons(const Attempt& attempt)
        : reach_(2.0 * chain_reach(attempt)), snap_(attempt.options.snap) {}

    std::vector<Place> take() { return std::move(places_); }

    void add(Point2 p, bool is_reason) { places_.push_back({p, reach_, is_reason}); }

    /// Where they cross, or come within snap of each other. The place of lines that are almost
    /// parallel moves along them with rounding: the radius says how far.
    void add_crossing(const Line& s, const Line& e) {
        const double sx = s.b.x - s.a.x, sy = s.b.y - s.a.y;
        const double ex = e.b.x - e.a.x, ey = e.b.y - e.a.y;
        const double sine = std::fabs(compensated_doubled_area({0.0, 0.0}, {sx, sy}, {ex, ey})) /
                            (std::sqrt(sx * sx + sy * sy) * std::sqrt(ex * ex + ey * ey));
        if (cross_properly(s.a, s.b, e.a, e.b)) {
            const double share = crossing_share(s.a, s.b, e.a, e.b);
            const Point2 p{s.a.x + sx * share, s.a.y + sy * share};
            places_.push_back({p, reach_ / sine, true});
        } else if (snap_ > 0.0) {
            add_nearest(s, e, reach_ / sine);
        }
    }

  private:
    void add_nearest(const Line& s, const Line& e, double radius) {
        double least = snap_;
        bool found = false;
        Point2 nearest;
        const auto look = [&](Point2 p, const Line& line) {
            const double distance = distance_to_segment(p, line.a, line.b);
            if (distance > least) return;
            least = distance;
            nearest = p;
            found = true;
        };
        look(s.a, e);
        look(s.b, e);
        look(e.a, s);
        look(e.b, s);
        if (found) places_.push_back({nearest, std::isfinite(radius) ? radius : 0.0, true});
    }

    double reach_;
    double snap_;
    std::vector<Place> places_;
};

/// A group of places that may be one in which new vertices outnumber the reasons.
std::optional<Point2> find_excess(const std::vector<Place>& places) {
    std::vector<Box> boxes;
    boxes.reserve(places.size());
    for (const Place& place : places)
        boxes.push_back(Box::around(place.p, place.p, place.radius));
    BoxGrid grid(std::move(boxes));
    std::vector<bool> is_taken(places.size(), false);
    std::vector<std::size_t> cluster;
    for (std::size_t first = 0; first < places.size(); ++first) {
        if (is_taken[first]) continue;
        is_taken[first] = true;
        cluster.assign(1, first);
        std::size_t added = 0, reasons = 0;
        for (std::size_t k = 0; k < cluster.size(); ++k) {
            const Place& here = places[cluster[k]];
            ++(here.is_reason ? reasons : added);
            for (const std::uint32_t i : grid.near(Box::around(here.p, here.p, here.radius))) {
                const double radius = std::max(here.radius, places[i].radius);
                if (is_taken[i] || distance_between(here.p, places[i].p) > radius) continue;
                is_taken[i] = true;
                cluster.push_back(i);
            }
        }
        if (added > reasons) return places[first].p;
    }
    return std::nullopt;
}

std::vector<Place> places_of(const Attempt& attempt, std::span<const InputSegment> segments) {
    const Tin& tin = attempt.tin;
    Reasons reasons(attempt);
    std::vector<Line> points, lines, edges;
    for (const Shape& shape : attempt.shapes)
        for (const Path& path : shape.paths)
            for (const Point2 p : path.points)
                points.emplace_back(p, p);
    sort_out(points);
    for (const Line& point : points)
        reasons.add(point.a, true);
    for (const InputSegment& s : segments)
        lines.emplace_back(s.a, s.b);
    sort_out(lines);
    for (const auto& [v, w] : attempt.replaced.lines())
        edges.emplace_back(tin.plan(v), tin.plan(w));
    sort_out(edges);
    BoxGrid edge_grid(boxes_of(edges));
    BoxGrid line_grid(boxes_of(lines));
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const Box box = Box::around(lines[k].a, lines[k].b, attempt.options.snap);
        for (const std::uint32_t i : edge_grid.near(box))
            reasons.add_crossing(lines[k], edges[i]);
        for (const std::uint32_t i : line_grid.near(box))
            if (i > k) reasons.add_crossing(lines[k], lines[i]);
    }
    for (std::size_t v = attempt.replaced.vertex_count(); v < tin.vertex_count(); ++v)
        reasons.add(tin.plan({static_cast<std::uint32_t>(v)}), false);
    return reasons.take();
}

}  // namespace

std::optional<BrokenPromise> find_needless_vertex(const Attempt& attempt,
                                                  std::span<const InputSegment> segments) {
    if (attempt.tin.vertex_count() == attempt.replaced.vertex_count()) return std::nullopt;
    const auto excess = find_excess(places_of(attempt, segments));
    if (!excess) return std::nullopt;
    // The segment next to it is to blame.
    BrokenPromise broken{0, 0, 0, *excess};
    double least = HUGE_VAL;
    for (const InputSegment& s : segments) {
        const double distance = distance_to_segment(*excess, s.a, s.b);
        if (!(distance < least)) continue;
        least = distance;
        broken = {s.shape, s.path, s.index, *excess};
    }
    return broken;
}

}  // namespace tinsmith::core
