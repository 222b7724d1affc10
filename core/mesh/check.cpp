// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/check.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

class Checker {
  public:
    Checker(const Tin& tin, std::size_t limit) : tin_(tin), limit_(limit) {}

    std::vector<Violation> run() {
        check_vertices();
        // What follows indexes by what the triangles say, so that must be in range first.
        if (!check_ranges()) return std::move(found_);
        corners_.assign(tin_.vertex_count(), 0);
        for (std::uint32_t t = 0; t < tin_.triangle_count(); ++t)
            check_triangle({t});
        for (std::uint32_t v = 0; v < tin_.vertex_count(); ++v)
            check_fan({v});
        return std::move(found_);
    }

  private:
    void add(const char* law, std::string detail) {
        if (found_.size() < limit_) found_.push_back({law, std::move(detail)});
    }
    static std::string name(TriangleId t) { return "triangle " + std::to_string(t.value); }
    static std::string name(VertexId v) { return "vertex " + std::to_string(v.value); }

    void check_vertices() {
        for (std::uint32_t v = 0; v < tin_.vertex_count(); ++v) {
            const Tin::Vertex& vertex = tin_.vertex({v});
            for (const double value : {vertex.x, vertex.y, vertex.z})
                if (!std::isfinite(value) || !in_coordinate_range(value))
                    add("coordinate", name(VertexId{v}) + " is not finite or out of range");
        }
    }

    bool check_ranges() {
        const std::size_t before = found_.size();
        for (std::uint32_t t = 0; t < tin_.triangle_count(); ++t) {
            const Tin::Triangle& triangle = tin_.triangle({t});
            for (unsigned i = 0; i < 3; ++i) {
                const Side twin = triangle.twins[i];
                if (triangle.vertices[i].index() >= tin_.vertex_count())
                    add("vertex", name(TriangleId{t}) + " names a vertex that is not there");
                if (twin.valid() &&
                    (twin.index() > 2 || twin.triangle().index() >= tin_.triangle_count()))
                    add("adjacency", name(TriangleId{t}) + " names a twin that is not there");
            }
        }
        for (std::uint32_t v = 0; v < tin_.vertex_count(); ++v)
            if (tin_.vertex({v}).triangle.index() >= tin_.triangle_count())
                add("vertex", name(VertexId{v}) + " is used by no triangle");
        return found_.size() == before;
    }

    void check_triangle(TriangleId t) {
        const Tin::Triangle& triangle = tin_.triangle(t);
        const auto [a, b, c] = triangle.vertices;
        if (!is_left(tin_.plan(a), tin_.plan(b), tin_.plan(c)))
            add("orientation", name(t) + " is not strictly counter-clockwise");
        if ((triangle.marks & ~0x7077U) != 0) add("marks", name(t) + " has marks of no meaning");
        for (unsigned i = 0; i < 3; ++i) {
            ++corners_[triangle.vertices[i].index()];
            const Side side(t, i);
            const Side twin = tin_.twin(side);
            const bool inside = twin.valid() && tin_.facet(twin.triangle()) == triangle.facet;
            if (inside == tin_.separates_facets(side))
                add("marks", name(t) + " is wrong about where its facet ends");
            if (!twin.valid()) continue;
            if (tin_.twin(twin) != side || tin_.origin(twin) != tin_.destination(side) ||
                tin_.destination(twin) != tin_.origin(side))
                add("adjacency", name(t) + " and " + name(twin.triangle()) + " do not agree");
            else if (tin_.is_constrained(side) != tin_.is_constrained(twin) ||
                     tin_.is_locked(side) != tin_.is_locked(twin))
                add("marks",
                    name(t) + " and " + name(twin.triangle()) + " mark their edge differently");
        }
    }

    /// The vertex's triangle contains it, and all its triangles are in one fan.
    void check_fan(VertexId v) {
        const TriangleId first = tin_.vertex(v).triangle;
        const auto& vertices = tin_.triangle(first).vertices;
        if (vertices[0] != v && vertices[1] != v && vertices[2] != v) {
            add("vertex", name(v) + " is not a corner of its " + name(first));
            return;
        }
        const Side start(first, vertices[0] == v ? 0U : vertices[1] == v ? 1U : 2U);
        std::uint32_t counted = 0;
        Side s = start;
        do {
            ++counted;
            s = tin_.twin(s.previous());
        } while (s.valid() && s != start && counted <= corners_[v.index()]);
        if (!s.valid()) {
            for (s = tin_.twin(start); s.valid() && counted <= corners_[v.index()];
                 s = tin_.twin(s.next()))
                ++counted;
        }
        if (counted != corners_[v.index()])
            add("fan", name(v) + " has triangles that are not around it in one fan");
    }

    const Tin& tin_;
    std::size_t limit_;
    std::vector<Violation> found_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

std::vector<Violation> check_tin(const Tin& tin, std::size_t limit) {
    return Checker(tin, limit).run();
}

}  // namespace tinsmith::core
