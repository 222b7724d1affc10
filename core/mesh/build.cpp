// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/build.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/mesh/components.hpp"
#include "core/mesh/overlap.hpp"
#include "core/mesh/tin_builder.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

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
    const auto take = [this, v](Side s) {
        corner_seen_[s.code] = true;
        tin_.triangles_[s.triangle().index()].vertices[s.index()] = v;
    };
    // A fan that closes comes once around: each step turns left by less than half a turn, so that
    // it comes from below to above, as comparisons say it, once for each time around.
    const Point2 centre = tin_.plan(named);
    const auto is_above = [&](Side s) {
        const Point2 p = tin_.plan(tin_.destination(s));
        return p.y > centre.y || (p.y == centre.y && p.x > centre.x);
    };
    const bool begins_above = is_above(first);
    bool was_above = begins_above;
    int rises = 0;
    take(first);
    Side s = tin_.twin(first.previous());
    for (; s.valid() && s != first; s = tin_.twin(s.previous())) {  // counter-clockwise
        const bool above = is_above(s);
        rises += above && !was_above ? 1 : 0;
        was_above = above;
        take(s);
    }
    if (s.valid()) {
        rises += begins_above && !was_above ? 1 : 0;
        tin_.vertices_[v.index()].triangle = tin_.twin(first.previous()).triangle();
        if (rises > 1) folded_fault(named);
        return;
    }
    Side start = first;
    for (s = tin_.twin(first); s.valid(); s = tin_.twin(s)) {  // clockwise to the end of the fan
        s = s.next();
        take(s);
        start = s;
    }
    tin_.vertices_[v.index()].triangle = start.triangle();
    // A fan that overlaps itself passes the direction in which it starts a second time.
    const Point2 direction = tin_.plan(tin_.destination(start));
    for (s = tin_.twin(start.previous()); s.valid(); s = tin_.twin(s.previous())) {
        if (!holds_direction(s, direction)) continue;
        folded_fault(named);
        return;
    }
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

void TinBuilder::index_hints() {
    tin_.lay_out_hints();
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t) {
        const auto& [a, b, c] = tin_.triangles_[t].vertices;
        const Point2 p = tin_.plan(a), q = tin_.plan(b), r = tin_.plan(c);
        tin_.hints_[tin_.hint_cell({(p.x + q.x + r.x) / 3.0, (p.y + q.y + r.y) / 3.0})] = {t};
    }
    tin_.fill_hints();
}

Result<Tin> build_tin(const MeshData& data, const MeshNames& names) {
    return TinBuilder(data, names).build();
}

}  // namespace tinsmith::core
