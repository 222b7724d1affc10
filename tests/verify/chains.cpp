// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

namespace {

/// A constrained edge of the new mesh, left end first.
struct Constraint {
    std::uint32_t i, j;
    Point2 a, b;
};

/// A connected stretch of constrained edges along a segment, as distances from its start.
struct Stretch {
    double from;
    double to;
};

/// A constrained edge along a segment.
struct Piece {
    std::uint32_t i, j;
    Stretch stretch;
};

/// The constrained edges of the new mesh by the x of their left end, so that a segment looks at
/// few.
class ChainFinder {
  public:
    explicit ChainFinder(const Edit& edit) : edit_(edit) {
        for (const auto& [i, j] : edit.after.data.constraints) {
            Constraint c{i, j, edit.after.data.vertices[i].plan(),
                         edit.after.data.vertices[j].plan()};
            if (c.b.x < c.a.x) {
                std::swap(c.a, c.b);
                std::swap(c.i, c.j);
            }
            constraints_.push_back(c);
            longest_ = std::max(longest_, c.b.x - c.a.x);
        }
        std::sort(constraints_.begin(), constraints_.end(),
                  [](const Constraint& l, const Constraint& r) { return l.a.x < r.a.x; });
        explained_.assign(constraints_.size(), false);
    }

    /// Checks that chains of vertices within `reach` of a-b cover it wherever it is on the old
    /// mesh, and explains their edges.
    void cover(Point2 a, Point2 b, double reach, Faults& faults) {
        reach_ = reach;
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        double done = 0.0;
        find_stretches(a, b, length);
        stretches_.push_back({length, length});
        for (const Stretch& s : stretches_) {
            if (s.from > done + 2 * reach_) check_gap(a, b, done, s.from, faults);
            done = std::max(done, s.to);
        }
    }

    /// Explains the edge v-w if it is there whole.
    bool explain(std::uint32_t v, std::uint32_t w) {
        const Point2 a = edit_.after.data.vertices[v].plan();
        const Point2 b = edit_.after.data.vertices[w].plan();
        const double left = std::min(a.x, b.x);
        for (std::size_t k = first_from(left); k < constraints_.size(); ++k) {
            const Constraint& c = constraints_[k];
            if (c.a.x > left) break;
            if (std::minmax(c.i, c.j) == std::minmax(v, w)) return explained_[k] = true;
        }
        return false;
    }

    /// Constrained edges that no segment accounts for.
    void report_unexplained(Faults& faults) const {
        for (std::size_t k = 0; k < constraints_.size(); ++k)
            if (!explained_[k])
                faults.push_back(words("G3 the edge ", constraints_[k].i, " to ", constraints_[k].j,
                                       " is constrained and nothing asked for that"));
    }

  private:
    /// The first constraint that begins at x or right of it.
    std::size_t first_from(double x) const {
        const auto found =
            std::lower_bound(constraints_.begin(), constraints_.end(), x,
                             [](const Constraint& l, double r) { return l.a.x < r; });
        return static_cast<std::size_t>(found - constraints_.begin());
    }

    void find_stretches(Point2 a, Point2 b, double length) {
        const auto along = [&](Point2 p) {
            return ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length;
        };
        const auto [left, right] = std::minmax(a.x, b.x);
        pieces_.clear();
        for (std::size_t k = first_from(left - longest_ - reach_); k < constraints_.size(); ++k) {
            const Constraint& c = constraints_[k];
            if (c.a.x > right + reach_) break;
            if (c.b.x < left - reach_) continue;
            if (!is_within(c.a, a, b, reach_) || !is_within(c.b, a, b, reach_)) continue;
            explained_[k] = true;
            const auto [from, to] = std::minmax({along(c.a), along(c.b)});
            pieces_.push_back({c.i, c.j, {from, to}});
        }
        join();
    }

    /// Pieces that share a vertex become one stretch.
    void join() {
        stretches_.clear();
        std::sort(pieces_.begin(), pieces_.end(),
                  [](const Piece& l, const Piece& r) { return l.stretch.from < r.stretch.from; });
        // In order along the segment a connected chain is found front to back, but for pieces that
        // overlap; those are tried again until none is left that meets the stretch.
        std::vector<bool> used(pieces_.size(), false);
        for (std::size_t first = 0; first < pieces_.size(); ++first) {
            if (used[first]) continue;
            used[first] = true;
            met_.assign({pieces_[first].i, pieces_[first].j});
            Stretch all = pieces_[first].stretch;
            for (bool grew = true; grew;) {
                grew = false;
                for (std::size_t k = first + 1; k < pieces_.size(); ++k) {
                    if (used[k] || (!has_met(pieces_[k].i) && !has_met(pieces_[k].j))) continue;
                    used[k] = grew = true;
                    met_.push_back(pieces_[k].i);
                    met_.push_back(pieces_[k].j);
                    all = {std::min(all.from, pieces_[k].stretch.from),
                           std::max(all.to, pieces_[k].stretch.to)};
                }
            }
            stretches_.push_back(all);
        }
        std::sort(stretches_.begin(), stretches_.end(),
                  [](const Stretch& l, const Stretch& r) { return l.from < r.from; });
    }
    /// The newest first: the next piece of a chain begins where the last one ended.
    bool has_met(std::uint32_t v) const {
        return std::find(met_.rbegin(), met_.rend(), v) != met_.rend();
    }

    /// No chain covers the segment between these distances: right only where it is outside the
    /// mesh, or so near the outline that rounding decides. Asked where it may enter or leave a
    /// triangle and between.
    void check_gap(Point2 a, Point2 b, double from, double to, Faults& faults) {
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const auto at = [&](double distance) {
            return Point2{a.x + (b.x - a.x) * (distance / length),
                          a.y + (b.y - a.y) * (distance / length)};
        };
        const Point2 p = at(from), q = at(to);
        const TriangleGrid& grid = edit_.before.grid;
        std::vector<double> stops{from, to};
        grid.near({std::min(p.x, q.x), std::min(p.y, q.y)},
                  {std::max(p.x, q.x), std::max(p.y, q.y)}, [&](std::uint32_t t) {
                      const auto corners = grid.corners(t);
                      for (unsigned i = 0; i < 3; ++i) {
                          const Point2 c = corners[i], d = corners[(i + 1) % 3];
                          if (!cross_properly(a, b, c, d)) continue;
                          const double ea = doubled_area(c, d, a), eb = doubled_area(c, d, b);
                          stops.push_back(length * (ea / (ea - eb)));
                      }
                  });
        std::sort(stops.begin(), stops.end());
        for (std::size_t i = 1; i < stops.size(); ++i) {
            const double low = std::max(stops[i - 1], from), high = std::min(stops[i], to);
            if (high <= low + 4 * reach_) continue;
            const Point2 middle = at((low + high) / 2);
            if (grid.triangle_at(middle) == kNone || is_near_outline(middle)) continue;
            faults.push_back(words("G3 segment from ", a.x, " ", a.y, " to ", b.x, " ", b.y,
                                   " is not covered at ", middle.x, " ", middle.y));
            return;
        }
    }

    bool is_near_outline(Point2 p) const {
        const TriangleGrid& grid = edit_.before.grid;
        const double wide = 2 * reach_;
        bool found = false;
        grid.near({p.x - wide, p.y - wide}, {p.x + wide, p.y + wide}, [&](std::uint32_t t) {
            const auto& corners = grid.mesh().triangles[t];
            for (unsigned i = 0; i < 3 && !found; ++i) {
                const std::uint32_t v = corners[i], w = corners[(i + 1) % 3];
                found = edit_.before.stars.triangle_of(w, v) == kNone &&
                        is_within(p, grid.mesh().vertices[v].plan(), grid.mesh().vertices[w].plan(),
                                  wide);
            }
        });
        return found;
    }

    const Edit& edit_;
    double reach_ = 0.0;
    double longest_ = 0.0;
    std::vector<Constraint> constraints_;
    std::vector<bool> explained_;
    std::vector<Piece> pieces_;       ///< of the segment at hand
    std::vector<Stretch> stretches_;  ///< of the segment at hand
    std::vector<std::uint32_t> met_;  ///< vertices of the stretch at hand
};

/// A path that is one position is a vertex there, where that is on the mesh.
void check_lone_points(const Edit& edit, double reach, Faults& faults) {
    for (const auto& shape : edit.shapes) {
        for (const auto& path : shape.paths) {
            const auto& points = path.points;
            const auto other = std::find_if(points.begin(), points.end(),
                                            [&](Point2 p) { return p != points.front(); });
            if (points.empty() || other != points.end()) continue;
            const Point2 p = points.front();
            const auto& vertices = edit.after.data.vertices;
            const bool is_vertex = std::any_of(vertices.begin(), vertices.end(), [&](Point3 v) {
                return is_within(v.plan(), p, p, reach);
            });
            if (!is_vertex && edit.before.grid.holds(p, -2 * reach))
                faults.push_back(words("G3 there is no vertex at the point ", p.x, " ", p.y));
        }
    }
}

}  // namespace

Faults check_chains(const Edit& edit) {
    Faults faults;
    const double reach = chain_reach(edit);
    ChainFinder finder(edit);
    for (const Segment& s : segments_of(edit.shapes))
        finder.cover(s.a, s.b, reach, faults);
    // What was there is held to rounding, whatever the request may snap.
    const auto& old = edit.before.data;
    for (const auto& [i, j] : old.constraints)
        if (!finder.explain(i, j))
            finder.cover(old.vertices[i].plan(), old.vertices[j].plan(),
                         edit.before.grid.rounding_reach(), faults);
    finder.report_unexplained(faults);
    check_lone_points(edit, reach, faults);
    return faults;
}

}  // namespace tinsmith::verify
