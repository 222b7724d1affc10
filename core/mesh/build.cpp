// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/build.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

/// Builds in passes, each of which needs what the earlier ones proved.
class TinBuilder {
  public:
    explicit TinBuilder(const MeshData& data) : data_(data) {}

    Result<Tin> build() {
        check_coordinates();
        check_triangles();
        if (!errors_.empty()) return std::move(errors_);
        link();
        if (!errors_.empty()) return std::move(errors_);
        collect_fans();
        if (!errors_.empty()) return std::move(errors_);
        mark_constraints();
        if (!errors_.empty()) return std::move(errors_);
        index();
        return std::move(tin_);
    }

  private:
    void fault(ErrorCode code, std::string detail, ErrorPlace place) {
        if (errors_.size() < kMaxFaults) errors_.push_back({code, std::move(detail), place});
    }
    void triangle_fault(ErrorCode code, std::size_t t, const std::string& what) {
        ErrorPlace place;
        place.triangle = t;
        const std::uint32_t v = data_.triangles[t][0];
        if (v < data_.vertices.size()) place.position = data_.vertices[v].plan();
        fault(code, "triangle " + std::to_string(t) + " " + what, place);
    }
    void vertex_fault(ErrorCode code, std::size_t v, const std::string& what) {
        ErrorPlace place;
        place.vertex = v;
        place.position = data_.vertices[v].plan();
        fault(code, "vertex " + std::to_string(v) + " " + what, place);
    }

    void check_coordinates();
    void check_triangles();
    void link();
    void collect_fans();
    void collect_fan(Side first);
    void mark_constraints();
    void index();
    void index_hints();

    const MeshData& data_;
    Tin tin_;
    Errors errors_;
    std::vector<std::uint8_t> corner_seen_;
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
    for (std::size_t v = 0; v < data_.vertices.size(); ++v) {
        const Point3& p = data_.vertices[v];
        for (const double value : {p.x, p.y, p.z}) {
            ErrorPlace place;
            place.vertex = v;
            if (!std::isfinite(value)) {
                fault(ErrorCode::CoordinateNotFinite,
                      "vertex " + std::to_string(v) + " has a coordinate that is not finite",
                      place);
                break;
            }
            if (!in_coordinate_range(value)) {
                fault(ErrorCode::CoordinateOutOfRange,
                      "vertex " + std::to_string(v) +
                          " has a coordinate out of range: magnitudes " +
                          "from 1e-60 to 1e15, and zero, are accepted",
                      place);
                break;
            }
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
        if (!errors_.empty() && errors_.front().code == ErrorCode::CoordinateNotFinite) continue;
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

/// Finds each side's twin through a chain of sides for each first vertex.
void TinBuilder::link() {
    const std::size_t count = data_.triangles.size();
    tin_.reserve_growth(data_.vertices.size(), count);
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = data_.triangles[t];
        tin_.triangles_.push_back(
            {{VertexId{a}, VertexId{b}, VertexId{c}}, {}, {static_cast<std::uint32_t>(t)}, 0});
    }
    tin_.next_facet_ = static_cast<std::uint32_t>(count);

    std::vector<Side> head(data_.vertices.size());
    std::vector<Side> next(4 * count);
    const auto find = [&](VertexId from, VertexId to) {
        Side s = head[from.index()];
        while (s.valid() && tin_.destination(s) != to)
            s = next[s.code];
        return s;
    };
    for (std::uint32_t t = 0; t < count; ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            const VertexId from = tin_.origin(side);
            const VertexId to = tin_.destination(side);
            if (find(from, to).valid()) {
                triangle_fault(ErrorCode::EdgeNotManifold, t,
                               "repeats the edge from vertex " + std::to_string(from.value) +
                                   " to " + std::to_string(to.value) +
                                   " of another triangle on the same side: they overlap");
                continue;
            }
            next[side.code] = head[from.index()];
            head[from.index()] = side;
            const Side twin = find(to, from);
            if (!twin.valid()) continue;
            tin_.triangles_[t].twins[i] = twin;
            tin_.triangles_[twin.triangle().index()].twins[twin.index()] = side;
        }
    }
}

void TinBuilder::collect_fans() {
    const std::size_t count = data_.vertices.size();
    for (const Point3& p : data_.vertices)
        tin_.vertices_.push_back({p.x, p.y, p.z, {}});
    corner_seen_.assign(4 * tin_.triangles_.size(), 0);
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            if (corner_seen_[Side({t}, i).code] == 0) collect_fan({{t}, i});
    for (std::size_t v = 0; v < count; ++v)
        if (!tin_.vertices_[v].triangle.valid())
            vertex_fault(ErrorCode::VertexUnused, v, "is used by no triangle; leave it out");
    corner_seen_ = {};
}

/// Walks the triangles around the origin of `first` once, gives them their vertex, and counts how
/// often they turn around it: once at most, or the mesh folds over itself there.
void TinBuilder::collect_fan(Side first) {
    VertexId v = tin_.origin(first);
    if (tin_.vertex(v).triangle.valid()) {  // a second fan at the same position
        const Tin::Vertex copy = tin_.vertex(v);
        v = {static_cast<std::uint32_t>(tin_.vertices_.size())};
        tin_.vertices_.push_back({copy.x, copy.y, copy.z, {}});
    }
    // Clockwise to the end of the fan, or once around.
    Side start = first;
    while (tin_.twin(start).valid() && tin_.twin(start).next() != first)
        start = tin_.twin(start).next();
    const bool closed = tin_.twin(start).valid();

    const Point2 centre = tin_.plan(v);
    const auto is_upper = [centre](Point2 p) {
        return p.y > centre.y || (p.y == centre.y && p.x > centre.x);
    };
    unsigned turns = 0;
    Side s = start;
    do {
        corner_seen_[s.code] = 1;
        if (!is_upper(tin_.plan(tin_.destination(s))) && is_upper(tin_.plan(tin_.apex(s)))) ++turns;
        tin_.triangles_[s.triangle().index()].vertices[s.index()] = v;
        s = tin_.twin(s.previous());
    } while (s.valid() && s != start);
    tin_.vertices_[v.index()].triangle = start.triangle();
    if (turns > 1 || (closed && turns != 1)) {
        ErrorPlace place;
        place.vertex = tin_.origin(first).index();
        place.position = centre;
        fault(ErrorCode::VertexFolded,
              "the triangles around the vertex overlap one another: a TIN has one elevation at "
              "each position",
              place);
    }
}

void TinBuilder::mark_constraints() {
    for (std::size_t i = 0; i < data_.constraints.size(); ++i) {
        const auto [from, to] = data_.constraints[i];
        bool found = false;
        if (from < data_.vertices.size() && to < data_.vertices.size()) {
            const TriangleId t = tin_.vertex({from}).triangle;
            unsigned corner = 0;
            while (tin_.triangle(t).vertices[corner].value != from)
                ++corner;
            const Side start(t, corner);
            Side s = start;
            do {  // the triangle stored is the clockwise end of the fan
                for (const Side side : {s, s.previous()}) {
                    const VertexId a = tin_.origin(side);
                    const VertexId b = tin_.destination(side);
                    if ((a.value != from || b.value != to) && (a.value != to || b.value != from))
                        continue;
                    found = true;
                    tin_.triangles_[side.triangle().index()].marks |= 1U << side.index();
                    const Side twin = tin_.twin(side);
                    if (twin.valid())
                        tin_.triangles_[twin.triangle().index()].marks |= 1U << twin.index();
                }
                s = tin_.twin(s.previous());
            } while (!found && s.valid() && s != start);
        }
        if (!found) {
            fault(ErrorCode::VertexIndexOutOfRange,
                  "constraint " + std::to_string(i) + " joins vertices " + std::to_string(from) +
                      " and " + std::to_string(to) + ", which no edge of the mesh does",
                  {});
        }
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

    std::vector<Side> boundary;
    for (std::uint32_t t = 0; t < tin_.triangles_.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            if (!tin_.triangles_[t].twins[i].valid()) boundary.push_back({{t}, i});
    tin_.boundary_ = BoundaryIndex(box.min.plan(), box.max.plan(), boundary.size());
    for (const Side s : boundary) {
        const VertexId v = tin_.origin(s);
        tin_.boundary_.add(v, tin_.plan(v), tin_.plan(tin_.destination(s)));
    }
    index_hints();
}

/// About one hint for sixteen triangles. Cells without a vertex take the hint before them.
void TinBuilder::index_hints() {
    const double cells = static_cast<double>(tin_.triangles_.size()) / 16.0;
    const std::size_t columns = static_cast<std::size_t>(std::clamp(std::sqrt(cells), 1.0, 4096.0));
    tin_.hint_columns_ = columns;
    tin_.hints_.assign(columns * columns, {});
    const Bounds& box = tin_.bounds_;
    const double last = static_cast<double>(columns - 1);
    const double per_x = static_cast<double>(columns) / (box.max.x - box.min.x);
    const double per_y = static_cast<double>(columns) / (box.max.y - box.min.y);
    for (const Tin::Vertex& v : tin_.vertices_) {
        const auto column = static_cast<std::size_t>(std::min(last, (v.x - box.min.x) * per_x));
        const auto row = static_cast<std::size_t>(std::min(last, (v.y - box.min.y) * per_y));
        tin_.hints_[row * columns + column] = v.triangle;
    }
    TriangleId before = tin_.vertices_[0].triangle;
    for (TriangleId& hint : tin_.hints_) {
        if (!hint.valid()) hint = before;
        before = hint;
    }
}

Result<Tin> build_tin(const MeshData& data) {
    return TinBuilder(data).build();
}

}  // namespace tinsmith::core
