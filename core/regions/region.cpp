// SPDX-License-Identifier: Apache-2.0
#include "core/regions/region.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/integrate/distance.hpp"
#include "core/integrate/reach.hpp"
#include "core/mesh/triangle_map.hpp"
#include "core/mesh/triangle_set.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"
#include "core/regions/winding_number.hpp"

namespace tinsmith::core {

namespace {

/// Finds a region in four steps: the jumps of the winding number across chain edges; from them the
/// winding of all triangles at the chains, up to one unknown for each connected group of these; one
/// exact winding number for each group; and from the triangles inside, a flood that never meets a
/// chain again, for all triangles beside one are known.
class RegionSearch {
  public:
    RegionSearch(const Tin& tin, const ConstraintHistory& history, const Outline& outline,
                 Winding winding)
        : tin_(tin),
          winding_(winding),
          place_in_belt_(tin.triangle_count()),
          seen_(tin.triangle_count()) {
        collect_lines(history, outline);
        close_joints(history);
        settle_jumps();
    }

    std::vector<TriangleId> run() {
        const WindingNumber number(segments_);
        collect_belt();
        settle_belt(number);
        for (const TriangleId t : belt_)
            seen_.insert(t);
        for (std::size_t i = 0; i < belt_.size(); ++i)
            if (is_inside(belt_winding_[i])) flood(belt_[i]);
        for (const TriangleId seed : tin_.components())
            if (is_inside_untouched(seed, number) && seen_.insert(seed)) flood(seed);
        std::sort(found_.begin(), found_.end());
        return std::move(found_);
    }

  private:
    bool is_inside(int winding) const {
        return winding_ == Winding::EvenOdd ? winding % 2 != 0 : winding != 0;
    }

    /// The lines that decide: the chains' edges and the parts outside, of all closed paths.
    void collect_lines(const ConstraintHistory& history, const Outline& outline) {
        for (const Chain& chain : outline.chains) {
            if (!outline.shape.paths[chain.path].closed) continue;
            const std::vector<VertexId> line = history.expand(chain.vertices);
            for (const VertexId name : line)
                history.for_each_slot(name, [this](VertexId v) { vertices_.push_back(v); });
            for (std::size_t i = 1; i < line.size(); ++i) {
                const auto [side, origin_is_first] = history.edge_between(line[i - 1], line[i]);
                add_jump(side, origin_is_first ? 1 : -1);
                // What was removed still parts the inside from the outside.
                const auto from = history.plan_of(line[i - 1]), to = history.plan_of(line[i]);
                if (from && to) segments_.push_back({*from, *to});
            }
            if (line.empty()) continue;
            joints_.emplace_back(line.front(), -1);
            joints_.emplace_back(line.back(), 1);
        }
        for (const OutsidePart& part : outline.outside) {
            if (!outline.shape.paths[part.path].closed) continue;
            for (std::size_t i = 1; i < part.points.size(); ++i)
                segments_.push_back({part.points[i - 1], part.points[i]});
        }
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    }

    /// The winding number is higher by `times` on the left of the side than on its right.
    void add_jump(Side side, int times) {
        if (!side.valid()) return;
        jumps_.emplace_back(side, times);
        if (const Side twin = tin_.twin(side); twin.valid()) jumps_.emplace_back(twin, -times);
    }

    /// A path that left the mesh within rounding of the boundary did so from a vertex that is not
    /// on it: the last step, which no edge takes, goes to the nearer end of the nearest boundary
    /// edge there. So it leaves most of the needle between them on the right side.
    void close_joints(const ConstraintHistory& history) {
        std::sort(joints_.begin(), joints_.end());
        for (std::size_t i = 0; i < joints_.size();) {
            const VertexId name = joints_[i].first;
            int ends = 0;
            for (; i < joints_.size() && joints_[i].first == name; ++i)
                ends += joints_[i].second;
            if (ends == 0) continue;
            history.for_each_slot(name, [&](VertexId v) {
                if (!boundary_side_from(tin_, v).valid()) add_jump(outlet_at(v), ends);
            });
        }
    }

    /// The side from v to there; invalid where nothing is near.
    Side outlet_at(VertexId v) const {
        const Point2 p = tin_.plan(v);
        Side outlet;
        double least = HUGE_VAL;
        for_each_side_at(tin_, v, [&](Side s) {
            while (tin_.origin(s) != v)
                s = s.next();
            if (tin_.twin(s.next()).valid()) return;
            const VertexId a = tin_.destination(s), b = tin_.apex(s);
            const Point2 at_a = tin_.plan(a), at_b = tin_.plan(b);
            const double distance = distance_to_segment(p, at_a, at_b);
            if (!(distance < least)) return;
            least = distance;
            // To b it is the triangle across that starts at v.
            const bool is_a = distance_between(p, at_a) <= distance_between(p, at_b);
            outlet = is_a ? s : tin_.twin(s.previous());
        });
        return outlet;
    }

    /// One entry for each side, those without a jump left out.
    void settle_jumps() {
        std::sort(jumps_.begin(), jumps_.end());
        std::size_t kept = 0;
        for (std::size_t i = 0; i < jumps_.size();) {
            const Side side = jumps_[i].first;
            int sum = 0;
            for (; i < jumps_.size() && jumps_[i].first == side; ++i)
                sum += jumps_[i].second;
            if (sum != 0) jumps_[kept++] = {side, sum};
        }
        jumps_.resize(kept);
    }

    int jump(Side side) const {
        const auto found =
            std::lower_bound(jumps_.begin(), jumps_.end(), side,
                             [](const auto& entry, Side s) { return entry.first < s; });
        return found != jumps_.end() && found->first == side ? found->second : 0;
    }

    /// The triangles at the chains' vertices.
    void collect_belt() {
        for (const VertexId v : vertices_) {
            for_each_side_at(tin_, v, [this](Side s) {
                std::uint32_t& place = place_in_belt_.at(s.triangle());
                if (place != 0) return;
                belt_.push_back(s.triangle());
                place = static_cast<std::uint32_t>(belt_.size());
            });
        }
        belt_winding_.assign(belt_.size(), 0);
    }

    void settle_belt(const WindingNumber& number) {
        std::vector<bool> reached(belt_.size(), false);
        std::vector<std::size_t> group;
        for (std::size_t first = 0; first < belt_.size(); ++first) {
            if (reached[first]) continue;
            reached[first] = true;
            group.assign(1, first);
            for (std::size_t k = 0; k < group.size(); ++k) {
                for (unsigned i = 0; i < 3; ++i) {
                    const Side side(belt_[group[k]], i);
                    if (!tin_.twin(side).valid()) continue;
                    const std::uint32_t place = place_in_belt_.value(tin_.twin(side).triangle());
                    if (place == 0 || reached[place - 1]) continue;
                    reached[place - 1] = true;
                    belt_winding_[place - 1] = belt_winding_[group[k]] - jump(side);
                    group.push_back(place - 1);
                }
            }
            const int base = unknown_of(group, number);
            for (const std::size_t i : group)
                belt_winding_[i] += base;
        }
    }

    /// What the group's windings lack, from an exact winding number in its largest triangle that
    /// holds its centroid's double. In one that is some ulps wide none may; then from a vertex that
    /// is on no chain, or at last from the middle of the longest edge along none.
    int unknown_of(const std::vector<std::size_t>& group, const WindingNumber& number) const {
        double largest = 0.0;
        std::optional<std::size_t> best;
        Point2 inner;
        for (const std::size_t i : group) {
            const double area = doubled_area_of(belt_[i]);
            if (!(area > largest)) continue;
            const auto [u, v, w] = tin_.triangle(belt_[i]).vertices;
            const Point2 a = tin_.plan(u), b = tin_.plan(v), c = tin_.plan(w);
            const Point2 centre = centroid(belt_[i]);
            if (!is_left(a, b, centre) || !is_left(b, c, centre) || !is_left(c, a, centre))
                continue;
            largest = area;
            best = i;
            inner = centre;
        }
        if (best) return number.around(inner) - belt_winding_[*best];
        for (const std::size_t i : group)
            for (const VertexId v : tin_.triangle(belt_[i]).vertices)
                if (!std::binary_search(vertices_.begin(), vertices_.end(), v))
                    return number.around(tin_.plan(v)) - belt_winding_[i];
        return number_at_an_edge(group, number);
    }

    int number_at_an_edge(const std::vector<std::size_t>& group,
                          const WindingNumber& number) const {
        double longest = 0.0;
        int found = 0;
        for (const std::size_t i : group) {
            for (unsigned k = 0; k < 3; ++k) {
                const Side side(belt_[i], k);
                const Point2 a = tin_.plan(tin_.origin(side));
                const Point2 b = tin_.plan(tin_.destination(side));
                const double length = distance_between(a, b);
                if (!(length > longest) || jump(side) != 0) continue;
                longest = length;
                found = number.around({a.x + (b.x - a.x) / 2.0, a.y + (b.y - a.y) / 2.0}) -
                        belt_winding_[i];
            }
        }
        return found;
    }

    /// Whether the component is inside as a whole, for no chain touches it. A line that passes it
    /// by may run through corners of it or along its edges, to within rounding: so one of the
    /// triangles around the seed tells whose centroid is clear of all lines; mostly the seed's is.
    bool is_inside_untouched(TriangleId seed, const WindingNumber& number) {
        const double rounding = 8.0 * reach_of_rounding(tin_);
        constexpr std::size_t kMost = 64;
        double largest = -1.0;
        Point2 best;
        near_seed_.assign(1, seed);
        for (std::size_t next = 0; next < near_seed_.size(); ++next) {
            const TriangleId t = near_seed_[next];
            // From the triangles at the chains all that is inside was reached.
            if (seen_.contains(t)) return false;
            const Point2 centre = centroid(t);
            if (number.is_clear(centre, rounding)) return is_inside(number.around(centre));
            if (const double area = doubled_area_of(t); area > largest) {
                largest = area;
                best = centre;
            }
            for (const Side twin : tin_.triangle(t).twins)
                if (twin.valid() && near_seed_.size() < kMost &&
                    std::find(near_seed_.begin(), near_seed_.end(), twin.triangle()) ==
                        near_seed_.end())
                    near_seed_.push_back(twin.triangle());
        }
        return is_inside(number.around(best));
    }

    Point2 centroid(TriangleId t) const {
        const auto [u, v, w] = tin_.triangle(t).vertices;
        const Point2 a = tin_.plan(u), b = tin_.plan(v), c = tin_.plan(w);
        return {a.x + ((b.x - a.x) + (c.x - a.x)) / 3.0, a.y + ((b.y - a.y) + (c.y - a.y)) / 3.0};
    }

    double doubled_area_of(TriangleId t) const {
        const auto [u, v, w] = tin_.triangle(t).vertices;
        return estimate_doubled_area(tin_.plan(u), tin_.plan(v), tin_.plan(w)).value;
    }

    /// Adds the triangle and all that are reached from it without meeting one that was seen.
    void flood(TriangleId start) {
        std::size_t next = found_.size();
        found_.push_back(start);
        for (; next < found_.size(); ++next)
            for (const Side twin : tin_.triangle(found_[next]).twins)
                if (twin.valid() && seen_.insert(twin.triangle()))
                    found_.push_back(twin.triangle());
    }

    const Tin& tin_;
    const Winding winding_;
    std::vector<VertexId> vertices_;                ///< of the chains, each once, in order
    std::vector<DirectedSegment> segments_;         ///< all lines that decide
    std::vector<std::pair<VertexId, int>> joints_;  ///< chains that end there, less that start
    std::vector<std::pair<Side, int>> jumps_;   ///< winding on the side's left less on its right
    std::vector<TriangleId> belt_;              ///< triangles at the chains, in order of these
    TriangleMap<std::uint32_t> place_in_belt_;  ///< from 1 on; 0: not there
    std::vector<int> belt_winding_;             ///< theirs
    TriangleSet seen_;
    std::vector<TriangleId> near_seed_;
    std::vector<TriangleId> found_;
};

/// A sum whose error does not grow with the number of terms. Source: Neumaier 1974.
class Sum {
  public:
    void add(double value) {
        const double sum = sum_ + value;
        rest_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + rest_; }

  private:
    double sum_ = 0.0;
    double rest_ = 0.0;
};

void measure(const Tin& tin, Region& region) {
    Sum plan, surface;
    for (const TriangleId t : region.triangles) {
        const auto [u, v, w] = tin.triangle(t).vertices;
        const Point3 a = tin.vertex(u).point(), b = tin.vertex(v).point(),
                     c = tin.vertex(w).point();
        const double upward = doubled_area(a.plan(), b.plan(), c.plan());
        const double abx = b.x - a.x, aby = b.y - a.y, abz = b.z - a.z;
        const double acx = c.x - a.x, acy = c.y - a.y, acz = c.z - a.z;
        const double east = aby * acz - abz * acy;
        const double north = abz * acx - abx * acz;
        plan.add(upward / 2.0);
        surface.add(std::sqrt(upward * upward + east * east + north * north) / 2.0);
    }
    region.plan_area = plan.value();
    region.surface_area = surface.value();
}

}  // namespace

Region find_region(const Tin& tin, const ConstraintHistory& history, const Outline& outline,
                   Winding winding) {
    Region region;
    region.triangles = RegionSearch(tin, history, outline, winding).run();
    measure(tin, region);
    return region;
}

}  // namespace tinsmith::core
