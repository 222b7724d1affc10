// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/overlap.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

/// The order in which the sweep comes by: from west to east, and upwards where that is equal.
bool comes_before(Point2 a, Point2 b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// An edge of the boundary, from where the sweep meets it first.
struct Edge {
    Point2 left;
    Point2 right;
    VertexId left_vertex;
    VertexId right_vertex;
    TriangleId triangle;
    /// What crossing it upwards adds to the number of triangles: the mesh is on a side's left.
    int step = 0;
    /// How many triangles are right above it, where the sweep is now. Of edges that lie along one
    /// another only the last one's counts.
    mutable int above = 0;
};

/// Orders edges that the sweep line meets, from below. Requires: they do not cross.
struct Below {
    using is_transparent = void;

    bool operator()(const Edge* e, const Edge* f) const {
        // The one that began later is looked at from the other, which is there all along.
        if (comes_before(f->left, e->left)) return side(f, e) == Orientation::Clockwise;
        return side(e, f) == Orientation::CounterClockwise;
    }
    bool operator()(const Edge* e, Point2 p) const {
        return orientation(e->left, e->right, p) == Orientation::CounterClockwise;
    }
    bool operator()(Point2 p, const Edge* e) const {
        return orientation(e->left, e->right, p) == Orientation::Clockwise;
    }

  private:
    /// On which side of `e` the edge `f`, that begins no earlier, runs on.
    static Orientation side(const Edge* e, const Edge* f) {
        const Orientation begin = orientation(e->left, e->right, f->left);
        return begin != Orientation::Collinear ? begin : orientation(e->left, e->right, f->right);
    }
};

class BoundarySweep {
  public:
    BoundarySweep(const Tin& tin, std::size_t most) : tin_(tin), most_(most) {}

    std::vector<Overlap> run() {
        collect();
        std::size_t next = 0;
        for (std::size_t i = 0; i < stops_.size() && !is_over_;) {
            const Point2 p = stops_[i].place;
            const std::size_t begin = i;
            while (i < stops_.size() && stops_[i].place == p)
                ++i;
            compare_elevations(begin, i);
            const std::size_t first = next;
            while (next < edges_.size() && edges_[next].left == p)
                ++next;
            pass(p, first, next);
        }
        return std::move(found_);
    }

  private:
    using Status = std::multiset<const Edge*, Below>;
    struct Stop {
        Point2 place;
        VertexId vertex;
    };

    void collect() {
        for (std::uint32_t t = 0; t < tin_.triangle_count(); ++t)
            for (unsigned i = 0; i < 3; ++i) {
                const Side side({t}, i);
                if (tin_.twin(side).valid()) continue;
                Edge edge{tin_.plan(tin_.origin(side)),
                          tin_.plan(tin_.destination(side)),
                          tin_.origin(side),
                          tin_.destination(side),
                          {t},
                          1,
                          0};
                stops_.push_back({edge.left, edge.left_vertex});
                if (comes_before(edge.right, edge.left)) {
                    std::swap(edge.left, edge.right);
                    std::swap(edge.left_vertex, edge.right_vertex);
                    edge.step = -1;
                }
                edges_.push_back(edge);
            }
        const auto from_left = [](const Edge& e, const Edge& f) {
            if (e.left != f.left) return comes_before(e.left, f.left);
            // Those from one place in the order of their slopes, from below.
            const Orientation turn = orientation(e.left, e.right, f.right);
            if (turn != Orientation::Collinear) return turn == Orientation::CounterClockwise;
            return e.triangle < f.triangle;
        };
        std::sort(edges_.begin(), edges_.end(), from_left);
        // Every boundary vertex begins one edge at least.
        std::sort(stops_.begin(), stops_.end(), [](const Stop& a, const Stop& b) {
            return a.place == b.place ? a.vertex < b.vertex : comes_before(a.place, b.place);
        });
    }

    void compare_elevations(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin + 1; i < end; ++i) {
            const VertexId a = stops_[begin].vertex, b = stops_[i].vertex;
            if (tin_.vertex(a).z == tin_.vertex(b).z || found_.size() >= most_) continue;
            found_.push_back({stops_[i].place, {}, b});
            return;
        }
    }

    void refuse(const Edge& edge, Point2 p) {
        is_over_ = true;
        if (found_.size() >= most_) found_.pop_back();
        found_.push_back({p, edge.triangle, {}});
    }

    /// Whether the interiors of two edges meet in one point.
    static bool cross(const Edge& e, const Edge& f) {
        const Orientation a = orientation(e.left, e.right, f.left);
        const Orientation b = orientation(e.left, e.right, f.right);
        if (a == Orientation::Collinear || b == Orientation::Collinear || a == b) return false;
        const Orientation c = orientation(f.left, f.right, e.left);
        const Orientation d = orientation(f.left, f.right, e.right);
        return c != Orientation::Collinear && d != Orientation::Collinear && c != d;
    }

    static bool are_along(const Edge& e, const Edge& f, Point2 p) {
        return orientation(p, e.right, f.right) == Orientation::Collinear;
    }

    /// The sweep comes by a place: edges end there, go on through it, and begin there.
    void pass(Point2 p, std::size_t first, std::size_t last) {
        auto [begin, end] = status_.equal_range(p);
        const Edge* through = nullptr;
        after_.clear();
        for (auto at = begin; at != end; ++at) {
            if ((*at)->right == p) continue;
            // Two edges through one place that are not along one another cross there.
            if (through != nullptr && !are_along(*through, **at, p)) return refuse(**at, p);
            through = *at;
            after_.push_back(*at);
        }
        for (std::size_t i = first; i < last; ++i)
            after_.push_back(&edges_[i]);
        const auto slope = [p](const Edge* e, const Edge* f) {
            return orientation(p, e->right, f->right) == Orientation::CounterClockwise;
        };
        std::inplace_merge(after_.begin(), after_.end() - static_cast<std::ptrdiff_t>(last - first),
                           after_.end(), slope);
        status_.erase(begin, end);
        int count = end == status_.begin() ? 0 : (*std::prev(end))->above;
        const auto above = end;
        for (std::size_t i = 0; i < after_.size(); ++i) {
            const Edge& edge = *after_[i];
            count += edge.step;
            edge.above = count;
            status_.emplace_hint(above, &edge);
            const bool is_last_along =
                i + 1 == after_.size() || !are_along(edge, *after_[i + 1], p);
            if (is_last_along && count != 0 && count != 1) return refuse(edge, p);
        }
        check_neighbours(above, p);
    }

    /// The edges that have become neighbours may cross farther on.
    void check_neighbours(Status::iterator above, Point2 p) {
        auto lowest = above;
        std::advance(lowest, -static_cast<std::ptrdiff_t>(after_.size()));
        if (lowest != status_.begin() && lowest != status_.end() &&
            cross(**std::prev(lowest), **lowest))
            return refuse(**lowest, p);
        if (after_.empty() || above == status_.end()) return;
        if (cross(**std::prev(above), **above)) refuse(**above, p);
    }

    const Tin& tin_;
    const std::size_t most_;
    std::vector<Edge> edges_;  ///< by their left ends
    std::vector<Stop> stops_;  ///< by place
    Status status_;            ///< edges that the sweep line meets, from below
    std::vector<const Edge*> after_;
    std::vector<Overlap> found_;
    bool is_over_ = false;
};

}  // namespace

std::vector<Overlap> find_overlaps(const Tin& tin, std::size_t most) {
    return BoundarySweep(tin, most).run();
}

}  // namespace tinsmith::core
