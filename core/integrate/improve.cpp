// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve.hpp"

#include <algorithm>
#include <cmath>

#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

void Improver::improve(const std::vector<VertexId>& vertices) {
    for (const VertexId v : vertices) {
        push_star(v);
        while (!pending_.empty()) {
            // A side that an earlier swap moved names another edge of the same two triangles, all
            // of whose edges that swap pushed anew: looking at it costs time, never a miss.
            const Side s = pending_.back();
            pending_.pop_back();
            if (tin_.is_fixed(s) || tin_.separates_facets(s) || !should_swap(s)) continue;
            const Side diagonal = surgery_.swap_edge(s);
            ++edges_swapped_;
            const Side across = tin_.twin(diagonal);
            pending_.insert(pending_.end(), {diagonal.next(), diagonal.previous(), across.next(),
                                             across.previous()});
        }
    }
}

void Improver::push_star(VertexId v) {
    const Side start = side_from(tin_, v);
    Side s = start;
    do {  // counter-clockwise
        pending_.insert(pending_.end(), {s, s.next()});
        s = tin_.twin(s.previous());
    } while (s.valid() && s != start);
    if (s.valid()) return;
    for (s = tin_.twin(start); s.valid(); s = tin_.twin(s)) {
        s = s.next();
        pending_.insert(pending_.end(), {s, s.next()});
    }
}

/// Whether the edge fails Delaunay's condition in the plane of its facet: the angles across from
/// it, at c and d, sum to more than 180 degrees. Areas in plan stand for the sines, for all
/// triangles of a facet are foreshortened alike.
bool Improver::should_swap(Side s) const {
    const Side across = tin_.twin(s);
    const Tin::Vertex& a = tin_.vertex(tin_.origin(s));
    const Tin::Vertex& b = tin_.vertex(tin_.destination(s));
    const Tin::Vertex& c = tin_.vertex(tin_.apex(s));
    const Tin::Vertex& d = tin_.vertex(tin_.apex(across));
    const auto angle_at = [&a, &b](const Tin::Vertex& v) {
        const double ax = a.x - v.x, ay = a.y - v.y, az = a.z - v.z;
        const double bx = b.x - v.x, by = b.y - v.y, bz = b.z - v.z;
        struct {
            double cosine, sine;
        } scaled{ax * bx + ay * by + az * bz, std::fabs(ax * by - ay * bx)};
        return scaled;
    };
    const auto at_c = angle_at(c);
    const auto at_d = angle_at(d);
    const double first = at_c.cosine * at_d.sine;
    const double second = at_d.cosine * at_c.sine;
    // Cocircular to within rounding: either diagonal will do, so the one that is there stays.
    constexpr double kRounding = 1e-13;
    if (!(first + second < -kRounding * (std::fabs(first) + std::fabs(second)))) return false;
    if (!is_left(a.plan(), d.plan(), c.plan()) || !is_left(d.plan(), b.plan(), c.plan()))
        return false;
    const double now = std::min(smallest_angle_measure(a.point(), b.point(), c.point()),
                                smallest_angle_measure(b.point(), a.point(), d.point()));
    const double then = std::min(smallest_angle_measure(a.point(), d.point(), c.point()),
                                 smallest_angle_measure(d.point(), b.point(), c.point()));
    return then > now;
}

}  // namespace tinsmith::core
