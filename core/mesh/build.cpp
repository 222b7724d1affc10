// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/build.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/mesh/components.hpp"
#include "core/mesh/overlap.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

/// Builds in passes, each of which needs what the earlier ones proved.
class TinBuilder {
  public:
    TinBuilder(const MeshData& data, const MeshNames& names) : data_(data), names_(names) {}

    Result<Tin> build() {
        check_coordinates();
        check_triangles();
        if (!errors_.empty()) return std::move(errors_);
        link();
        if (!errors_.empty()) return std::move(errors_);
        collect_fans();
        if (!errors_.empty()) return std::move(errors_);
        check_overlaps();
        if (!errors_.empty()) return std::move(errors_);
        index();
        return std::move(tin_);
    }

  private:
    void fault(ErrorCode code, std::string detail, ErrorPlace place) {
        if (errors_.size() < kMaxFaults) errors_.push_back({code, std::move(detail), place});
    }
    static std::size_t name(std::span<const std::uint32_t> names, std::size_t i) {
        return i < names.size() ? names[i] : i;
    }
    std::size_t triangle_name(std::size_t t) const { return name(names_.triangles, t); }
    std::size_t vertex_name(std::size_t v) const { return name(names_.vertices, v); }
    void triangle_fault(ErrorCode code, std::size_t t, const std::string& what) {
        ErrorPlace place;
        place.triangle = triangle_name(t);
        const std::uint32_t v = data_.triangles[t][0];
        if (v < data_.vertices.size()) place.position = data_.vertices[v].plan();
        fault(code, "triangle " + std::to_string(*place.triangle) + " " + what, place);
    }
    void vertex_fault(ErrorCode code, std::size_t v, const std::string& what) {
        ErrorPlace place;
        place.vertex = vertex_name(v);
        place.position = data_.vertices[v].plan();
        fault(code, "vertex " + std::to_string(*place.vertex) + " " + what, place);
    }

    void check_coordinates();
    void check_triangles();
    void sort_sides();
    Side find_side(VertexId from, VertexId to) const;
    void link();
    void mark_constraints();
    void collect_fans();
    void collect_fan(Side first);
    bool holds_direction(Side s, Point2 p) const;
    void check_copies();
    Side side_at(VertexId v) const;
    void folded_fault(VertexId named);
    void check_overlaps();
    void index();
    void index_hints();

    const MeshData& data_;
    const MeshNames& names_;
    Tin tin_;
    Errors errors_;
    std::vector<bool> bad_vertex_;           ///< whose coordinates are at fault
    std::vector<std::uint32_t> first_side_;  ///< where a vertex's bucket begins in sides_
    std::vector<Side> sides_;
    std::vector<bool> corner_seen_;  ///< by the code of the side that starts there
    std::vector<std::pair<VertexId, VertexId>> copies_;  ///< vertex, copy for a further fan
};

void TinBuilder::check_coordinates() {
    if (data_.triangles.empty()) {
        fault(ErrorCode::MeshEmpty, "the mesh has no triangle; give at least one", {});
        return;
    }
    if (data_.triangles.size() > kMaxTriangles || data_.vertices.size() > kMaxVertices) {
        fault(ErrorCode::MeshTooLarge, "more triangles or vertices than ids can count", {});
        return;
    }
    bad_vertex_.assign(data_.vertices.size(), false);
    for (std::size_t v = 0; v < data_.vertices.size(); ++v) {
        const Point3& p = data_.vertices[v];
        for (const double value : {p.x, p.y, p.z}) {
            if (std::isfinite(value) && in_coordinate_range(value)) continue;
            bad_vertex_[v] = true;
            ErrorPlace place;
            place.vertex = vertex_name(v);
            const std::string which =
                "vertex " + std::to_string(*place.vertex) + " has a coordinate ";
            if (std::isfinite(value))
                fault(ErrorCode::CoordinateOutOfRange,
                      which + "out of range: zero and magnitudes from 1e-60 to 1e15 are accepted",
                      place);
            else
                fault(ErrorCode::CoordinateNotFinite, which + "that is not finite", place);
            break;
        }
    }
}

void TinBuilder::check_triangles() {
    const std::size_t vertices = data_.vertices.size();
    for (std::size_t t = 0; t < data_.triangles.size(); ++t) {
        const auto [a, b, c] = data_.triangles[t];
        if (a >= vertices || b >= vertices || c >= vertices) {
            triangle_fault(ErrorCode::VertexIndexOutOfRange, t,
                           "names vertex " + std::to_string(std::max({a, b, c})) + "; there are " +
                               std::to_string(vertices));
            continue;
        }
        if (bad_vertex_[a] || bad_vertex_[b] || bad_vertex_[c]) continue;
        switch (orientation(data_.vertices[a].plan(), data_.vertices[b].plan(),
                            data_.vertices[c].plan())) {
            case Orientation::CounterClockwise:
                break;
            case Orientation::Collinear:
                triangle_fault(ErrorCode::TriangleFlat, t, "has no area in plan; leave it out");
                break;
            case Orientation::Clockwise:
                triangle_fault(
                    ErrorCode::TriangleClockwise, t,
                    "is clockwise seen from above; list its vertices the other way round");
                break;
        }
    }
}

/// Sides by their first vertex, in each of its buckets by their second: O(n log d) however many
/// triangles share a vertex.
void TinBuilder::sort_sides() {
    const std::size_t count = data_.triangles.size();
    first_side_.assign(data_.vertices.size() + 1, 0);
    for (const auto& triangle : data_.triangles)
        for (const std::uint32_t v : triangle)
            ++first_side_[v + 1];
    for (std::size_t v = 0; v < data_.vertices.size(); ++v)
        first_side_[v + 1] += first_side_[v];
    sides_.resize(3 * count);
    std::vector<std::uint32_t> filled(first_side_.begin(), first_side_.end() - 1);
    for (std::uint32_t t = 0; t < count; ++t)
        for (unsigned i = 0; i < 3; ++i)
            sides_[filled[data_.triangles[t][i]]++] = Side({t}, i);
    const auto by_destination = [this](Side l, Side r) {
        const VertexId a = tin_.destination(l), b = tin_.destination(r);
        return a != b ? a < b : l < r;
    };
    for (std::size_t v = 0; v < data_.vertices.size(); ++v)
        std::sort(sides_.begin() + first_side_[v], sides_.begin() + first_side_[v + 1],
                  by_destination);
}

/// The first side from one vertex to another; invalid where there is none.
Side TinBuilder::find_side(VertexId from, VertexId to) const {
    const auto end = sides_.begin() + first_side_[from.index() + 1];
    const auto found =
        std::lower_bound(sides_.begin() + first_side_[from.index()], end, to,
                         [this](Side s, VertexId v) { return tin_.destination(s) < v; });
    return found != end && tin_.destination(*found) == to ? *found : Side{};
}

void TinBuilder::link() {
    const std::size_t count = data_.triangles.size();
    tin_.reserve_growth(data_.vertices.size(), count);
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = data_.triangles[t];
        tin_.triangles_.push_back(
            {{VertexId{a}, VertexId{b}, VertexId{c}}, {}, {static_cast<std::uint32_t>(t)}, 0});
    }
    tin_.next_facet_ = static_cast<std::uint32_t>(count);
    sort_sides();
    for (std::uint32_t t = 0; t < count; ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const VertexId from = tin_.origin(side);
            const VertexId to = tin_.destination(side);
            if (find_side(from, to) == side) {
                tin_.triangles_[t].twins[i] = find_side(to, from);
                continue;
            }
            triangle_fault(ErrorCode::EdgeNotManifold, t,
                           "repeats the edge from vertex " +
                               std::to_string(vertex_name(from.value)) + " to " +
                               std::to_string(vertex_name(to.value)) +
                               " of another triangle on the same side: they overlap");
        }
    }
    if (errors_.empty()) mark_constraints();
    sides_ = {};
    first_side_ = {};
}

void TinBuilder::mark_constraints() {
    for (std::size_t i = 0; i < data_.constraints.size(); ++i) {
        const auto [from, to] = data_.constraints[i];
        Side side;
        if (std::max(from, to) < data_.vertices.size()) {
            side = find_side({from}, {to});
            if (!side.valid()) side = find_side({to}, {from});
        }
        if (!side.valid()) {
            fault(ErrorCode::VertexIndexOutOfRange,
                  "constraint " + std::to_string(i) + " joins vertices " + std::to_string(from) +
                      " and " + std::to_string(to) + ", which no edge of the mesh does",
                  {});
            continue;
        }
        for (const Side s : {side, tin_.twin(side)})
            if (s.valid()) tin_.triangles_[s.triangle().index()].marks |= 1U << s.index();
    }
}

void TinBuilder::collect_fans() {
    const std::size_t count = data_.vertices.size();
    for (const Point3& p : data_.vertices)
        tin_.vertices_.push_back({p.x, p.y, p.z, {}});
    corner_seen_.assign(4 * tin_.triangles_.size(), false);
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            if (!corner_seen_[Side({t}, i).code]) collect_fan({{t}, i});
    for (std::size_t v = 0; v < count; ++v)
        if (!tin_.vertices_[v].triangle.valid())
            vertex_fault(ErrorCode::VertexUnused, v, "is used by no triangle; leave it out");
    corner_seen_ = {};
    check_copies();
}

/// Walks the triangles around the origin of `first` once and gives them their vertex: the one they
/// name, or a copy of it where another fan has that one.
void TinBuilder::collect_fan(Side first) {
    const VertexId named = tin_.origin(first);
    VertexId v = named;
    if (tin_.vertex(named).triangle.valid()) {
        const Tin::Vertex copy = tin_.vertex(named);
        v = {static_cast<std::uint32_t>(tin_.vertices_.size())};
        tin_.vertices_.push_back({copy.x, copy.y, copy.z, {}});
        copies_.emplace_back(named, v);
    }
    // Clockwise to the end of the fan, or once around.
    Side start = first;
    while (tin_.twin(start).valid() && tin_.twin(start).next() != first)
        start = tin_.twin(start).next();

    // A fan that overlaps itself passes the direction in which it starts a second time.
    const Point2 direction = tin_.plan(tin_.destination(start));
    bool overlaps = false;
    Side s = start;
    do {
        corner_seen_[s.code] = true;
        if (s != start && holds_direction(s, direction)) overlaps = true;
        tin_.triangles_[s.triangle().index()].vertices[s.index()] = v;
        s = tin_.twin(s.previous());
    } while (s.valid() && s != start);
    tin_.vertices_[v.index()].triangle = start.triangle();
    if (overlaps) folded_fault(named);
}

/// Whether the ray from the side's origin through `p` runs in the side's triangle, its first edge
/// included and its second not.
bool TinBuilder::holds_direction(Side s, Point2 p) const {
    const Point2 centre = tin_.plan(tin_.origin(s));
    const Point2 right = tin_.plan(tin_.destination(s));
    const Orientation turn = orientation(centre, right, p);
    if (turn == Orientation::Collinear) return is_ahead(centre, right, p);
    return turn == Orientation::CounterClockwise && is_left(centre, p, tin_.plan(tin_.apex(s)));
}

/// Fans that share a vertex overlap when one starts within the one before it, going round.
void TinBuilder::check_copies() {
    std::sort(copies_.begin(), copies_.end());
    for (std::size_t i = 0; i < copies_.size();) {
        const VertexId named = copies_[i].first;
        const Point2 centre = tin_.plan(named);
        std::vector<Side> fans{side_at(named)};
        for (; i < copies_.size() && copies_[i].first == named; ++i)
            fans.push_back(side_at(copies_[i].second));
        const auto start_of = [this](Side s) { return tin_.plan(tin_.destination(s)); };
        const auto is_upper = [centre](Point2 p) {
            return p.y > centre.y || (p.y == centre.y && p.x > centre.x);
        };
        std::sort(fans.begin(), fans.end(), [&](Side l, Side r) {
            const Point2 p = start_of(l), q = start_of(r);
            if (is_upper(p) != is_upper(q)) return is_upper(p);
            return is_left(centre, p, q);
        });
        for (std::size_t k = 0; k < fans.size(); ++k) {
            const Point2 next = start_of(fans[(k + 1) % fans.size()]);
            bool overlaps = false;
            for (Side s = fans[k]; s.valid() && !overlaps; s = tin_.twin(s.previous()))
                overlaps = holds_direction(s, next);
            if (overlaps) folded_fault(named);
        }
    }
}

/// The side that starts at v in v's own triangle.
Side TinBuilder::side_at(VertexId v) const {
    const TriangleId t = tin_.vertex(v).triangle;
    const auto& vertices = tin_.triangle(t).vertices;
    return {t, vertices[0] == v ? 0U : vertices[1] == v ? 1U : 2U};
}

void TinBuilder::folded_fault(VertexId named) {
    vertex_fault(ErrorCode::VertexFolded, named.index(),
                 "has triangles around it that overlap one another: a TIN has one elevation at "
                 "each position");
}

/// What no edge and no vertex shows: parts that lie over one another, and cliffs.
void TinBuilder::check_overlaps() {
    for (const Overlap& overlap : find_overlaps(tin_, kMaxFaults)) {
        if (overlap.triangle.valid()) {
            triangle_fault(ErrorCode::MeshOverlaps, overlap.triangle.index(),
                           "lies over or under another part of the mesh: a TIN has one elevation "
                           "at each position");
            errors_.back().place.position = overlap.place;
            continue;
        }
        const auto copied = std::find_if(copies_.begin(), copies_.end(), [&](const auto& copy) {
            return copy.second == overlap.vertex;
        });
        const VertexId named = copied == copies_.end() ? overlap.vertex : copied->first;
        vertex_fault(ErrorCode::ElevationTwice, named.index(),
                     "lies where another vertex has another elevation: a TIN has one at each "
                     "position");
    }
}

void TinBuilder::index() {
    const auto& vertices = tin_.vertices_;
    Bounds box{vertices[0].point(), vertices[0].point()};
    for (const Tin::Vertex& v : vertices) {
        box.min = {std::min(box.min.x, v.x), std::min(box.min.y, v.y), std::min(box.min.z, v.z)};
        box.max = {std::max(box.max.x, v.x), std::max(box.max.y, v.y), std::max(box.max.z, v.z)};
    }
    tin_.bounds_ = box;

    tin_.boundary_ = tin_.index_boundary();
    tin_.components_ = find_components(tin_);
    tin_.built_vertex_count_ = tin_.vertices_.size();
    index_hints();
}

/// About one hint for three triangles. Cells without a triangle's centroid take the hint before
/// them.
void TinBuilder::index_hints() {
    const double cells = static_cast<double>(tin_.triangles_.size()) / 3.0;
    const std::size_t columns = static_cast<std::size_t>(std::clamp(std::sqrt(cells), 1.0, 8192.0));
    const Bounds& box = tin_.bounds_;
    tin_.hint_columns_ = columns;
    tin_.hint_origin_ = box.min.plan();
    tin_.hints_per_x_ = static_cast<double>(columns) / (box.max.x - box.min.x);
    tin_.hints_per_y_ = static_cast<double>(columns) / (box.max.y - box.min.y);
    tin_.hints_.assign(columns * columns, {});
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t) {
        const auto& [a, b, c] = tin_.triangles_[t].vertices;
        const Point2 p = tin_.plan(a), q = tin_.plan(b), r = tin_.plan(c);
        tin_.hints_[tin_.hint_cell({(p.x + q.x + r.x) / 3.0, (p.y + q.y + r.y) / 3.0})] = {t};
    }
    TriangleId before{0};
    for (TriangleId& hint : tin_.hints_) {
        if (!hint.valid()) hint = before;
        before = hint;
    }
}

Result<Tin> build_tin(const MeshData& data, const MeshNames& names) {
    return TinBuilder(data, names).build();
}

}  // namespace tinsmith::core
