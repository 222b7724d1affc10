// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

using core::Improve;

/// Rise over run of the plane of a, b, c.
double slope(Point3 a, Point3 b, Point3 c) {
    const double bz = b.z - a.z, cz = c.z - a.z;
    const double rise_y = (b.x - a.x) * cz - (c.x - a.x) * bz;
    const double rise_x = bz * (c.y - a.y) - cz * (b.y - a.y);
    return std::hypot(rise_x, rise_y) / doubled_area(a.plan(), b.plan(), c.plan());
}

/// The two surfaces of an edit, compared place by place.
class Comparison {
  public:
    Comparison(const Edit& edit, const Change& change) : edit_(edit), change_(change) {
        reach_ = edit.before.grid.rounding_reach();
        // A vertex may be within rounding of a triangle that only touches those that changed.
        for (const std::uint32_t t : change.removed)
            for (const std::uint32_t v : edit.before.data.triangles[t])
                for (const Corner& corner : edit.before.stars.around(v))
                    steepest_ = std::max(steepest_, slope(old_corner(corner.triangle, 0),
                                                          old_corner(corner.triangle, 1),
                                                          old_corner(corner.triangle, 2)));
        const double rounding = 1e-9 * edit.before.grid.extent() + reach_ * steepest_;
        promised_ = edit.certified;
        if (edit.options.improve == Improve::None || edit.options.improve == Improve::Strict)
            promised_ = rounding;
        if (edit.options.improve == Improve::Bounded)
            promised_ = edit.options.max_deviation + rounding;
        bound_ = std::min(promised_, edit.certified);
        find_set_vertices();
    }

    Faults run() {
        const auto& before = edit_.before.data.vertices;
        const auto& after = edit_.after.data.vertices;
        for (std::uint32_t v = 0; v < before.size(); ++v)
            if (before[v].z != after[v].z && !is_set(v))
                faults_.push_back(words("G2 the elevation of old vertex ", v, " changed"));
        for (auto v = static_cast<std::uint32_t>(before.size()); v < after.size(); ++v)
            if (!is_set(v)) compare_vertex(v);
        seen_.assign(change_.was_removed.size(), kNone);
        std::uint32_t edge = 0;
        for (const std::uint32_t t : change_.added) {
            for (unsigned i = 0; i < 3; ++i) {
                const std::uint32_t a = edit_.after.data.triangles[t][i];
                const std::uint32_t b = edit_.after.data.triangles[t][(i + 1) % 3];
                // Each edge from one side; the ends' elevations are all that it has.
                const std::uint32_t twin = edit_.after.stars.triangle_of(b, a);
                const bool mine = a < b || twin == kNone;
                if (mine && !is_set(a) && !is_set(b) && !is_between_set(t, twin))
                    compare_edge(a, b, edge++);
            }
        }
        return std::move(faults_);
    }

  private:
    Point3 old_corner(std::uint32_t t, unsigned i) const {
        return edit_.before.data.vertices[edit_.before.data.triangles[t][i]];
    }

    /// Vertices whose elevation the request may have set: those on a path with its own.
    void find_set_vertices() {
        const double reach = chain_reach(edit_);
        for (const Segment& s : segments_of(edit_.shapes)) {
            if (s.path->elevations.empty()) continue;
            is_set_.resize(edit_.after.data.vertices.size(), false);
            for (std::size_t v = 0; v < is_set_.size(); ++v)
                if (is_within(edit_.after.data.vertices[v].plan(), s.a, s.b, reach))
                    is_set_[v] = true;
        }
        for (const auto& shape : edit_.shapes) {
            for (const auto& path : shape.paths) {
                if (path.elevations.empty()) continue;
                is_set_.resize(edit_.after.data.vertices.size(), false);
                for (std::size_t v = 0; v < is_set_.size(); ++v)
                    for (const Point2 p : path.points)
                        if (is_within(edit_.after.data.vertices[v].plan(), p, p, reach))
                            is_set_[v] = true;
            }
        }
    }
    bool is_set(std::uint32_t v) const { return !is_set_.empty() && is_set_[v]; }

    /// Whether both triangles of an edge touch a vertex that was set. Swaps across facets may put
    /// an edge there that lies on the lifted surface.
    bool is_between_set(std::uint32_t t, std::uint32_t twin) const {
        if (is_set_.empty() || edit_.options.improve == Improve::None ||
            edit_.options.improve == Improve::Strict)
            return false;
        const auto touches = [this](std::uint32_t triangle) {
            const auto& corners = edit_.after.data.triangles[triangle];
            return std::any_of(corners.begin(), corners.end(),
                               [this](std::uint32_t v) { return is_set(v); });
        };
        return touches(t) && (twin == kNone || touches(twin));
    }

    void off(const char* what, Point2 p, double gap) {
        const char* which = gap > promised_ ? "G2 " : "CERTIFIED ";
        faults_.push_back(words(which, what, " at ", p.x, " ", p.y, " is off by ", gap,
                                ", promised ", promised_, ", certified ", edit_.certified));
    }

    void compare_vertex(std::uint32_t v) {
        const Point3 p = edit_.after.data.vertices[v];
        const std::uint32_t t = edit_.before.grid.triangle_at(p.plan());
        if (t == kNone) {
            compare_beyond_outline(p);
            return;
        }
        const Point3 a = old_corner(t, 0), b = old_corner(t, 1), c = old_corner(t, 2);
        if (!gap_to_plane_within(p, a, b, c, bound_) && !is_between_parts(p.plan()))
            off("new vertex", p.plan(), gap_to_plane(p, a, b, c));
    }

    /// Whether two outline edges that share no vertex are within rounding of p. Where parts of the
    /// mesh touch like that, a position has an elevation on each and rounding may put one part
    /// over the other: which of the two is meant cannot be told.
    bool is_between_parts(Point2 p) const {
        const Snapshot& before = edit_.before;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> outline;
        bool found = false;
        before.grid.near({p.x - reach_, p.y - reach_}, {p.x + reach_, p.y + reach_},
                         [&](std::uint32_t t) {
                             for (unsigned i = 0; i < 3; ++i) {
                                 const std::uint32_t v = before.data.triangles[t][i];
                                 const std::uint32_t w = before.data.triangles[t][(i + 1) % 3];
                                 if (before.stars.triangle_of(w, v) != kNone ||
                                     !is_within(p, before.data.vertices[v].plan(),
                                                before.data.vertices[w].plan(), reach_))
                                     continue;
                                 for (const auto& [a, b] : outline)
                                     found = found || (a != v && a != w && b != v && b != w);
                                 outline.emplace_back(v, w);
                             }
                         });
        return found;
    }

    /// A new vertex of the outline may be beyond the old one by rounding: the elevation there is
    /// that of the outline edge. No surface is compared, so that the measure may itself round.
    void compare_beyond_outline(Point3 p) {
        std::optional<double> least;
        edit_.before.grid.near(
            {p.x - reach_, p.y - reach_}, {p.x + reach_, p.y + reach_}, [&](std::uint32_t t) {
                for (unsigned i = 0; i < 3; ++i) {
                    const Point3 a = old_corner(t, i), b = old_corner(t, (i + 1) % 3);
                    if (!is_within(p.plan(), a.plan(), b.plan(), reach_)) continue;
                    const double dx = b.x - a.x, dy = b.y - a.y;
                    const double share = std::clamp(
                        ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
                    const double gap = std::fabs((p.z - a.z) - share * (b.z - a.z));
                    least = std::min(least.value_or(gap), gap);
                }
            });
        if (!least)
            faults_.push_back(words("G2 new vertex at ", p.x, " ", p.y, " is off the old plan"));
        else if (*least > bound_ * (1 + 1e-9) + 1e-15 * std::fabs(p.z))
            off("new vertex of the outline", p.plan(), *least);
    }

    void compare_edge(std::uint32_t ia, std::uint32_t ib, std::uint32_t edge) {
        const auto& after = edit_.after.data.vertices;
        const Point3 a = after[ia], b = after[ib];
        const Point2 low{std::min(a.x, b.x), std::min(a.y, b.y)};
        const Point2 high{std::max(a.x, b.x), std::max(a.y, b.y)};
        edit_.before.grid.near(low, high, [&](std::uint32_t t) {
            if (!change_.was_removed[t] || seen_[t] == edge) return;
            seen_[t] = edge;
            for (unsigned i = 0; i < 3; ++i) {
                const std::uint32_t ic = edit_.before.data.triangles[t][i];
                const std::uint32_t id = edit_.before.data.triangles[t][(i + 1) % 3];
                if (ic == ia || ic == ib || id == ia || id == ib) continue;
                if (ic > id && edit_.before.stars.triangle_of(id, ic) != kNone) continue;
                const Point3 c = old_corner(t, i), d = old_corner(t, (i + 1) % 3);
                if (!cross_properly(a.plan(), b.plan(), c.plan(), d.plan())) continue;
                if (gap_at_crossing_within(a, b, c, d, bound_)) continue;
                const Point2 p = crossing_point(a.plan(), b.plan(), c.plan(), d.plan());
                if (!is_between_parts(p)) off("edge", p, gap_at_crossing(a, b, c, d));
            }
        });
    }

    const Edit& edit_;
    const Change& change_;
    double reach_ = 0.0;
    double steepest_ = 0.0;
    double promised_ = 0.0;            ///< by the guarantee
    double bound_ = 0.0;               ///< the lesser of that and what the report certified
    std::vector<bool> is_set_;         ///< by new vertex; empty where no path brings elevations
    std::vector<std::uint32_t> seen_;  ///< by old triangle: the last new edge that met it
    Faults faults_;
};

}  // namespace

Faults check_surface(const Edit& edit, const Change& change) {
    return Comparison(edit, change).run();
}

}  // namespace tinsmith::verify
