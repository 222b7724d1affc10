// SPDX-License-Identifier: Apache-2.0
// The promise that the surface stays where it was.
#include <algorithm>
#include <cmath>

#include "core/integrate/box_grid.hpp"
#include "core/integrate/distance.hpp"
#include "core/integrate/promise.hpp"
#include "core/mesh/surface.hpp"

namespace tinsmith::core {

namespace {

using Corners = std::array<Point3, 3>;

/// How far above or below the plane of the corners p is, right to rounding.
double gap_to_plane(Point3 p, const Corners& corners) {
    const auto& [a, b, c] = corners;
    const double wa = compensated_doubled_area(b.plan(), c.plan(), p.plan());
    const double wb = compensated_doubled_area(c.plan(), a.plan(), p.plan());
    const double wc = compensated_doubled_area(a.plan(), b.plan(), p.plan());
    return std::fabs(wa * (a.z - p.z) + wb * (b.z - p.z) + wc * (c.z - p.z)) / (wa + wb + wc);
}

/// Vertical distance of a-b and c-d where they cross in plan.
double gap_at_crossing(Point3 a, Point3 b, Point3 c, Point3 d) {
    const double along_ab = crossing_share(a.plan(), b.plan(), c.plan(), d.plan());
    const double along_cd = crossing_share(c.plan(), d.plan(), a.plan(), b.plan());
    return std::fabs((a.z - c.z) + (b.z - a.z) * along_ab - (d.z - c.z) * along_cd);
}

class Comparison {
  public:
    Comparison(const Attempt& attempt, std::span<const InputSegment> segments)
        : attempt_(attempt), tin_(attempt.tin), old_(attempt.replaced), grid_(old_boxes()) {
        double certified = 0.0;
        for (const ShapeReport& report : attempt.reports)
            certified += report.max_vertical_deviation;
        double steepest = 0.0;
        for (const auto& corners : old_.removed()) {
            const Corners at = before(corners);
            steepest = std::max(steepest, steepest_slope(at[0], at[1], at[2]));
        }
        const Bounds& box = tin_.bounds();
        const double extent = distance_between(box.min.plan(), box.max.plan());
        bound_ = std::min(certified, 1e-9 * extent + attempt.reach * steepest);
        find_set_vertices(segments);
    }

    /// A position where the surface is not where it was.
    std::optional<Point2> find_gap() {
        for (std::size_t v = old_.vertex_count(); v < tin_.vertex_count(); ++v) {
            const VertexId id{static_cast<std::uint32_t>(v)};
            if (!is_set(id) && is_off(tin_.vertex(id).point())) return tin_.plan(id);
        }
        for (const TriangleId t : old_.added()) {
            for (unsigned i = 0; i < 3; ++i) {
                const Side side(t, i), twin = tin_.twin(side);
                if (twin.valid() && tin_.destination(side) < tin_.origin(side)) continue;
                if (auto gap = find_gap_along(tin_.origin(side), tin_.destination(side)))
                    return gap;
            }
        }
        return std::nullopt;
    }

  private:
    Corners before(const std::array<VertexId, 3>& corners) const {
        return {old_.before(corners[0]), old_.before(corners[1]), old_.before(corners[2])};
    }

    std::vector<Box> old_boxes() const {
        std::vector<Box> boxes;
        boxes.reserve(old_.removed().size());
        for (const auto& [a, b, c] : old_.removed()) {
            Box box = Box::around(tin_.plan(a), tin_.plan(b));
            box.include(Box::around(tin_.plan(c), tin_.plan(c)));
            boxes.push_back(box);
        }
        return boxes;
    }

    /// Vertices that the request may have given an elevation: those on a path with its own.
    void find_set_vertices(std::span<const InputSegment> segments) {
        const double reach = chain_reach(attempt_);
        std::vector<std::pair<Point2, Point2>> own;
        for (const InputSegment& s : segments)
            if (!attempt_.shapes[s.shape].paths[s.path].elevations.empty())
                own.emplace_back(s.a, s.b);
        for (const Shape& shape : attempt_.shapes)
            for (const Path& path : shape.paths)
                if (!path.elevations.empty())
                    for (const Point2 p : path.points)
                        own.emplace_back(p, p);
        if (own.empty()) return;
        std::vector<Box> boxes;
        boxes.reserve(own.size());
        for (const auto& [a, b] : own)
            boxes.push_back(Box::around(a, b, reach));
        BoxGrid near_own(std::move(boxes));
        const auto look = [&](VertexId v) {
            const Point2 p = tin_.plan(v);
            const auto& near = near_own.near(Box::around(p, p));
            if (std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
                    return distance_to_segment(p, own[i].first, own[i].second) <= reach;
                }))
                set_.push_back(v);
        };
        for (const TriangleId t : old_.added())
            for (const VertexId v : tin_.triangle(t).vertices)
                look(v);
        std::sort(set_.begin(), set_.end());
    }
    bool is_set(VertexId v) const { return std::binary_search(set_.begin(), set_.end(), v); }

    bool is_off(Point3 p) {
        for (const std::uint32_t i : grid_.near(Box::around(p.plan(), p.plan()))) {
            const Corners at = before(old_.removed()[i]);
            const auto is_beyond = [&](unsigned k) {
                return orientation(at[k].plan(), at[Side::next_of(k)].plan(), p.plan()) ==
                       Orientation::Clockwise;
            };
            if (!is_beyond(0) && !is_beyond(1) && !is_beyond(2))
                return gap_to_plane(p, at) > bound_;
        }
        return false;  // beyond the outline by rounding, with the outline's elevation
    }

    std::optional<Point2> find_gap_along(VertexId v, VertexId w) {
        if (is_set(v) || is_set(w)) return std::nullopt;
        const Point3 a = tin_.vertex(v).point(), b = tin_.vertex(w).point();
        for (const std::uint32_t k : grid_.near(Box::around(a.plan(), b.plan()))) {
            const auto& corners = old_.removed()[k];
            for (unsigned i = 0; i < 3; ++i) {
                const VertexId from = corners[i], to = corners[Side::next_of(i)];
                if (from == v || from == w || to == v || to == w) continue;
                const Point3 c = old_.before(from), d = old_.before(to);
                if (!cross_properly(a.plan(), b.plan(), c.plan(), d.plan())) continue;
                if (gap_at_crossing(a, b, c, d) > bound_) return c.plan();
            }
        }
        return std::nullopt;
    }

    const Attempt& attempt_;
    const Tin& tin_;
    const Replaced& old_;
    BoxGrid grid_;  ///< of the triangles that are no more
    double bound_ = 0.0;
    std::vector<VertexId> set_;  ///< in order
};

}  // namespace

std::optional<BrokenPromise> find_moved_surface(const Attempt& attempt,
                                                std::span<const InputSegment> segments) {
    if (attempt.replaced.removed().empty()) return std::nullopt;
    const auto gap = Comparison(attempt, segments).find_gap();
    if (!gap) return std::nullopt;
    BrokenPromise broken{0, 0, 0, *gap};
    double least = HUGE_VAL;
    for (const InputSegment& s : segments) {
        const double distance = distance_to_segment(*gap, s.a, s.b);
        if (!(distance < least)) continue;
        least = distance;
        broken = {s.shape, s.path, s.index, *gap};
    }
    return broken;
}

}  // namespace tinsmith::core
