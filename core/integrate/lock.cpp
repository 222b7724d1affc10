// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/lock.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/mesh/surgery.hpp"
#include "core/mesh/triangle_set.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

double distance(Point2 p, Point2 q) {
    return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
}

/// One segment of the line as an axis: positions along it from its start, and across it to its
/// left. `across` is right to rounding however long the segment is.
struct Axis {
    Point2 start;
    Point2 end;
    double length;
    double before;  ///< length of the line up to the start

    double along(Point2 p) const {
        return ((p.x - start.x) * (end.x - start.x) + (p.y - start.y) * (end.y - start.y)) / length;
    }
    double across(Point2 p) const { return compensated_doubled_area(start, end, p) / length; }
    Point2 at(double position) const {
        const double share = std::clamp(position / length, 0.0, 1.0);
        return {start.x + (end.x - start.x) * share, start.y + (end.y - start.y) * share};
    }
};

Axis axis_between(Point2 start, Point2 end, double before) {
    return {start, end, distance(start, end), before};
}

/// Distance from the segment, not from the line through it.
double distance_to(const Axis& axis, Point2 p) {
    const double along = axis.along(p);
    if (along <= 0.0) return distance(p, axis.start);
    if (along >= axis.length) return distance(p, axis.end);
    return std::fabs(axis.across(p));
}

/// From where to where, on an edge or on the line.
struct Interval {
    double from;
    double to;
};

/// A piece of an edge that lies along a piece of the line.
struct Match {
    Side edge;  ///< the lower side
    Interval on_edge;
    Interval on_line;
};

class LineSearch {
  public:
    LineSearch(const Tin& tin, double reach, LockBudget& budget)
        : tin_(tin), reach_(reach), budget_(budget) {}

    /// False where the budget ends it; then `refused` says why.
    bool search(const Axis& axis) {
        TriangleSet seen(tin_.triangle_count());
        std::vector<TriangleId> pending;
        const auto visit = [&](TriangleId t) {
            if (seen.insert(t)) pending.push_back(t);
        };
        for (const TriangleId t : seeds(axis))
            visit(t);
        while (!pending.empty()) {
            const TriangleId t = pending.back();
            pending.pop_back();
            if (!spend(1)) return false;
            for (unsigned i = 0; i < 3; ++i) {
                const Side side(t, i);
                if (!is_near(axis, side)) continue;
                const Side twin = tin_.twin(side);
                if (twin.valid()) visit(twin.triangle());
                if ((!twin.valid() || side < twin) && !match(axis, side)) return false;
            }
        }
        return !refused_;
    }

    const std::optional<Error>& refused() const { return refused_; }

    /// The edges that the matches cover from end to end, with what they cover of the line.
    std::pair<std::vector<Side>, std::vector<Interval>> covered() {
        std::sort(matches_.begin(), matches_.end(), [](const Match& l, const Match& r) {
            return l.edge != r.edge ? l.edge < r.edge : l.on_edge.from < r.on_edge.from;
        });
        std::vector<Side> edges;
        std::vector<Interval> on_line;
        for (std::size_t i = 0; i < matches_.size();) {
            const std::size_t first = i;
            const Side edge = matches_[i].edge;
            double end = 0.0;
            double missing = 0.0;
            for (; i < matches_.size() && matches_[i].edge == edge; ++i) {
                missing = std::max(missing, matches_[i].on_edge.from - end);
                end = std::max(end, matches_[i].on_edge.to);
            }
            if (std::max(missing, length_of(edge) - end) > reach_) continue;
            edges.push_back(edge);
            for (std::size_t k = first; k < i; ++k)
                on_line.push_back(matches_[k].on_line);
        }
        return {std::move(edges), std::move(on_line)};
    }

    double length_of(Side edge) const {
        return distance(tin_.plan(tin_.origin(edge)), tin_.plan(tin_.destination(edge)));
    }

  private:
    /// A triangle at the segment's start, and those at the boundary within reach: from these all
    /// triangles near the segment are reached through edges near it.
    std::vector<TriangleId> seeds(const Axis& axis) {
        std::vector<TriangleId> found;
        const Location start = locate(tin_, axis.start, tin_.hint(axis.start));
        if (start.kind == Location::Kind::OnVertex)
            found.push_back(tin_.vertex(start.vertex).triangle);
        else if (start.kind != Location::Kind::Outside)
            found.push_back(start.side.triangle());
        for (const VertexId v : tin_.boundary().near(axis.start, axis.end, reach_)) {
            if (!spend(1)) break;
            const Side edge = boundary_side_from(tin_, v);
            if (edge.valid() && is_near(axis, edge)) found.push_back(edge.triangle());
        }
        return found;
    }

    /// Whether any point of the edge is within reach of the segment.
    bool is_near(const Axis& axis, Side side) const {
        const Point2 p = tin_.plan(tin_.origin(side));
        const Point2 q = tin_.plan(tin_.destination(side));
        const auto [left, right] = std::minmax({axis.start.x, axis.end.x});
        const auto [low, high] = std::minmax({axis.start.y, axis.end.y});
        if (std::max(p.x, q.x) < left - reach_ || std::min(p.x, q.x) > right + reach_ ||
            std::max(p.y, q.y) < low - reach_ || std::min(p.y, q.y) > high + reach_)
            return false;
        const Axis edge = axis_between(p, q, 0.0);
        if (distance_to(axis, p) <= reach_ || distance_to(axis, q) <= reach_ ||
            distance_to(edge, axis.start) <= reach_ || distance_to(edge, axis.end) <= reach_)
            return true;
        return orientation(p, q, axis.start) != orientation(p, q, axis.end) &&
               orientation(axis.start, axis.end, p) != orientation(axis.start, axis.end, q);
    }

    /// Notes what of the edge lies along the segment. False where the budget ends it.
    bool match(const Axis& axis, Side side) {
        const Point2 p = tin_.plan(tin_.origin(side));
        const Point2 q = tin_.plan(tin_.destination(side));
        const double p_along = axis.along(p), q_along = axis.along(q);
        const double p_across = axis.across(p), q_across = axis.across(q);
        const double run = q_along - p_along;
        if (!(std::fabs(run) > std::fabs(q_across - p_across))) return true;
        // What of the edge is beside the segment, as shares of the edge.
        const double length = length_of(side);
        const auto [first, last] = std::minmax({-p_along / run, (axis.length - p_along) / run});
        const double from = std::max(0.0, first), to = std::min(1.0, last);
        if (!(from < to)) return true;
        const auto across_at = [&](double share) {
            return std::fabs(p_across + (q_across - p_across) * share);
        };
        if (across_at(from) > reach_ || across_at(to) > reach_) return true;
        const auto [low, high] = std::minmax({p_along + run * from, p_along + run * to});
        constexpr std::uint64_t kVisitsOfAMatch = 8;  // it takes more memory than a triangle seen
        if (!spend(kVisitsOfAMatch)) return false;
        matches_.push_back(
            {side, {from * length, to * length}, {axis.before + low, axis.before + high}});
        return true;
    }

    bool spend(std::uint64_t visits) {
        if (refused_) return false;
        if (visits > budget_.visits) {
            refused_ = Error{ErrorCode::CrossingBudget,
                             "the line has more edges within reach than allowed; allow less reach, "
                             "or send it in parts",
                             {}};
            return false;
        }
        budget_.visits -= visits;
        constexpr std::uint64_t kAskEvery = 4096;
        if (asked_++ % kAskEvery == 0 && budget_.cancelled && budget_.cancelled())
            refused_ = Error{ErrorCode::Cancelled, "the request was cancelled", {}};
        return !refused_;
    }

    const Tin& tin_;
    const double reach_;
    LockBudget& budget_;
    std::uint64_t asked_ = 0;
    std::optional<Error> refused_;
    std::vector<Match> matches_;
};

/// The segments of the line, those of no length left out.
std::vector<Axis> axes_of(const Path& line) {
    std::vector<Axis> axes;
    double before = 0.0;
    const std::size_t count = line.points.size();
    for (std::size_t i = 1; i < count + (line.closed ? 1 : 0); ++i) {
        const Point2 start = line.points[i - 1], end = line.points[i % count];
        if (start == end) continue;
        axes.push_back(axis_between(start, end, before));
        before += axes.back().length;
    }
    return axes;
}

/// The line between two positions on it, with its points on the way.
std::vector<Point2> stretch(const std::vector<Axis>& axes, Interval part) {
    auto axis = std::upper_bound(axes.begin() + 1, axes.end(), part.from,
                                 [](double from, const Axis& a) { return from < a.before; });
    --axis;
    std::vector<Point2> points{axis->at(part.from - axis->before)};
    for (; axis != axes.end() && axis->before < part.to; ++axis)
        points.push_back(axis->at(part.to - axis->before));
    return points;
}

/// What the intervals leave of the line, where it is longer than `reach`.
std::vector<std::vector<Point2>> rest_of(const std::vector<Axis>& axes,
                                         std::vector<Interval> intervals, double reach) {
    const double length = axes.back().before + axes.back().length;
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& l, const Interval& r) { return l.from < r.from; });
    intervals.push_back({length, length});
    std::vector<std::vector<Point2>> rest;
    double end = 0.0;
    for (const Interval& interval : intervals) {
        if (interval.from - end > reach) rest.push_back(stretch(axes, {end, interval.from}));
        end = std::max(end, interval.to);
    }
    return rest;
}

Errors check_line(const Path& line, const std::vector<Axis>& axes) {
    Errors errors;
    for (std::size_t i = 0; i < line.points.size() && errors.size() < kMaxFaults; ++i) {
        const Point2 p = line.points[i];
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y);
        if (finite && in_coordinate_range(p.x) && in_coordinate_range(p.y)) continue;
        ErrorPlace place;
        place.point = i;
        errors.push_back({finite ? ErrorCode::CoordinateOutOfRange : ErrorCode::CoordinateNotFinite,
                          "a coordinate is not finite or out of range", place});
    }
    if (errors.empty() && axes.empty())
        errors.push_back({ErrorCode::LineTooShort,
                          "the line has fewer than two distinct positions; give at least two",
                          {}});
    return errors;
}

}  // namespace

Result<LockReport> lock_along(Tin& tin, const Path& line, double reach, bool locked, Undo* undo,
                              LockBudget* budget) {
    const std::vector<Axis> axes = axes_of(line);
    if (Errors errors = check_line(line, axes); !errors.empty()) return errors;
    const Bounds& box = tin.bounds();
    const double largest = std::max(
        {std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.max.x), std::fabs(box.max.y)});
    reach = std::min(std::max(4.0 * ulp(largest), reach), kCoordinateLimit);

    LockBudget endless;
    LineSearch search(tin, reach, budget != nullptr ? *budget : endless);
    for (const Axis& axis : axes)
        if (!search.search(axis)) return *search.refused();
    auto [edges, on_line] = search.covered();
    if (edges.empty()) {
        ErrorPlace place;
        place.position = line.points.front();
        return Error{ErrorCode::NoEdgeAlong,
                     "no edge of the mesh lies along the line; integrate the line first, or allow "
                     "a larger reach",
                     place};
    }
    LockReport report;
    report.edges = edges.size();
    Surgery surgery(tin);
    for (const Side edge : edges) {
        report.length += search.length_of(edge);
        if (tin.is_locked(edge) == locked) continue;
        ++report.changed;
        surgery.set_locked(edge, locked);
    }
    report.without_edge = rest_of(axes, std::move(on_line), reach);
    UndoRecord record = surgery.commit();
    if (undo != nullptr) {
        undo->clear();
        undo->push_back(std::move(record));
    }
    return report;
}

}  // namespace tinsmith::core
