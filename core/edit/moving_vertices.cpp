// SPDX-License-Identifier: Apache-2.0
#include "core/edit/moving_vertices.hpp"

#include <algorithm>
#include <cstdint>

#include "core/edit/box_tree.hpp"
#include "core/integrate/distance.hpp"
#include "core/mesh/triangle_set.hpp"
#include "core/mesh/walk.hpp"
#include "core/regions/constraint_history.hpp"
#include "core/regions/coverage.hpp"

namespace tinsmith::core {

namespace {

/// Tells how far positions are from a shape's lines, as long as that is less than a bound.
class NearLines {
  public:
    NearLines(const Shape& shape, double bound) : bound_(bound) {
        std::vector<Box> boxes;
        for (const Path& path : shape.paths) {
            const std::size_t count = path.points.size();
            for (std::size_t i = 0; i < count; ++i) {
                segments_.push_back({path.points[i], path.points[(i + 1) % count]});
                boxes.push_back(Box::around(segments_.back().from, segments_.back().to));
            }
        }
        tree_.emplace(std::move(boxes));
    }

    double distance(Point2 p) {
        double least = bound_;
        tree_->near(Box::around(p, p, bound_), found_);
        for (const std::uint32_t s : found_)
            least = std::min(least, distance_to_segment(p, segments_[s].from, segments_[s].to));
        return least;
    }

  private:
    struct Segment {
        Point2 from;
        Point2 to;
    };
    double bound_;
    std::vector<Segment> segments_;
    std::optional<BoxTree> tree_;
    std::vector<std::uint32_t> found_;
};

/// Says of each vertex of the outer part what becomes of it; of several it is the later that holds.
enum class State : std::uint8_t { Elsewhere, Between, Full, Fixed };

class Sorting {
  public:
    Sorting(const Tin& tin, const Extent& extent)
        : tin_(tin), extent_(extent), states_(tin.vertex_count(), State::Elsewhere) {}

    std::vector<Moving> run() {
        mark(extent_.outer, State::Between);
        mark(extent_.full, State::Full);
        if (extent_.is_limited) fix_border();
        std::optional<NearLines> lines;
        if (extent_.lines != nullptr) lines.emplace(*extent_.lines, extent_.width);
        std::vector<Moving> moving;
        for (std::uint32_t i = 0; i < states_.size(); ++i) {
            if (states_[i] == State::Elsewhere) continue;
            const VertexId v{i};
            const std::vector<VertexId> together = at_the_place_of(v);
            if (together.front() != v) continue;  // told with the first that is not elsewhere
            const double share = share_of(state_of(together), tin_.plan(v), lines);
            if (!(share > 0.0)) continue;
            const VertexId leader = *std::min_element(together.begin(), together.end());
            for (const VertexId each : together)
                moving.push_back({each, share, leader});
        }
        std::ranges::sort(moving, {}, &Moving::vertex);
        return moving;
    }

  private:
    void mark(std::span<const TriangleId> triangles, State state) {
        for (const TriangleId t : triangles)
            for (const VertexId v : tin_.triangle(t).vertices)
                states_[v.index()] = std::max(states_[v.index()], state);
    }

    /// One fan of triangles is around a vertex: one that has another triangle, too, ends a side
    /// between both.
    void fix_border() {
        TriangleSet outer(tin_.triangle_count());
        for (const TriangleId t : extent_.outer)
            outer.insert(t);
        const Linework::Lines lines{0, extent_.limit};
        const Linework linework(ConstraintHistory(tin_), {&lines, 1});
        for (const TriangleId t : extent_.outer) {
            for (unsigned i = 0; i < 3; ++i) {
                const Side side(t, i), twin = tin_.twin(side);
                const bool ends = twin.valid() ? !outer.contains(twin.triangle())
                                               : !linework.along(tin_, side).empty();
                if (!ends) continue;
                states_[tin_.origin(side).index()] = State::Fixed;
                states_[tin_.destination(side).index()] = State::Fixed;
            }
        }
    }

    /// The vertex and its copies in other fans; those of the outer part first, in order.
    std::vector<VertexId> at_the_place_of(VertexId v) const {
        std::vector<VertexId> found{v};
        if (!boundary_side_from(tin_, v).valid()) return found;
        const Point2 p = tin_.plan(v);
        for (const VertexId w : tin_.boundary().near(p, p))
            if (w != v && tin_.plan(w) == p) found.push_back(w);
        std::ranges::sort(found, {}, [this](VertexId w) {
            return std::pair(states_[w.index()] == State::Elsewhere, w);
        });
        return found;
    }

    State state_of(const std::vector<VertexId>& together) const {
        State state = State::Elsewhere;
        for (const VertexId v : together) {
            const State own = states_[v.index()];
            if (own == State::Elsewhere && extent_.is_limited) return State::Fixed;
            state = std::max(state, own);
        }
        return state;
    }

    double share_of(State state, Point2 p, std::optional<NearLines>& lines) const {
        if (state == State::Full) return 1.0;
        if (state != State::Between || !lines) return 0.0;
        return 1.0 - lines->distance(p) / extent_.width;
    }

    const Tin& tin_;
    const Extent& extent_;
    std::vector<State> states_;
};

}  // namespace

std::vector<Moving> moving_vertices(const Tin& tin, const Extent& extent) {
    return Sorting(tin, extent).run();
}

}  // namespace tinsmith::core
