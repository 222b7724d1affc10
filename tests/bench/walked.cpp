// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/walked.hpp"

#include <algorithm>

namespace tinsmith::bench {

namespace {

using core::Side;
using core::Tin;
using core::TriangleId;
using core::VertexId;

/// The side from one vertex to the other; invalid where no edge joins them.
Side side_between(const Tin& tin, VertexId from, VertexId to) {
    for (const bool clockwise : {false, true}) {
        TriangleId at = tin.vertex(from).triangle;
        const TriangleId first = at;
        do {
            const Tin::Triangle& triangle = tin.triangle(at);
            unsigned corner = 0;
            while (triangle.vertices[corner] != from)
                ++corner;
            const Side out({at}, corner), in({at}, Side::previous_of(corner));
            if (tin.destination(out) == to) return out;
            if (tin.origin(in) == to) return in;
            const Side next = clockwise ? tin.twin(out) : tin.twin(in);
            if (!next.valid()) break;
            at = next.triangle();
        } while (at != first);
    }
    return {};
}

}  // namespace

Walked::Walked(const Tin& before, const Tin& after, const std::vector<core::Chain>& chains) {
    std::vector<bool> is_told(after.triangle_count(), false);
    const auto add = [&](TriangleId id) {
        const bool is_new = id.index() >= before.triangle_count();
        if (is_told[id.index()] || (!is_new && before.triangle(id) == after.triangle(id))) return;
        is_told[id.index()] = true;
        way_.push_back({id.value, is_new, after.triangle(id)});
    };
    const auto add_around = [&](Side side) {
        if (!side.valid()) return;
        add(side.triangle());
        for (const Side out : after.triangle(side.triangle()).twins)
            if (out.valid()) add(out.triangle());
    };
    for (const core::Chain& chain : chains) {
        for (std::size_t i = 0; i + 1 < chain.vertices.size(); ++i) {
            const Side side = side_between(after, chain.vertices[i], chain.vertices[i + 1]);
            add_around(side);
            if (side.valid()) add_around(after.twin(side));
        }
    }
    // Farther away: swaps for better triangles.
    for (std::uint32_t t = 0; t < after.triangle_count(); ++t)
        add({t});
    for (std::uint32_t v = 0; v < after.vertex_count(); ++v) {
        const Tin::Vertex& now = after.vertex({v});
        if (v >= before.vertex_count() || before.vertex({v}).triangle != now.triangle)
            vertices_.push_back({v, now});
    }
    old_vertices_ = before.vertex_count();
}

Walked::Slots Walked::copy_of(const Tin& before) const {
    Slots slots;
    slots.vertices.reserve(before.vertex_count() + vertices_.size());
    slots.triangles.reserve(before.triangle_count() + way_.size());
    for (std::uint32_t v = 0; v < before.vertex_count(); ++v)
        slots.vertices.push_back(before.vertex({v}));
    for (std::uint32_t t = 0; t < before.triangle_count(); ++t)
        slots.triangles.push_back(before.triangle({t}));
    return slots;
}

double Walked::go(Slots& slots, bool dependent) const {
    double sum = 0.0;
    std::size_t next = 0;
    while (next < way_.size()) {
        const Step& step = way_[next];
        std::size_t forward = 1;
        if (step.is_new) {
            slots.triangles.push_back(step.written);
        } else {
            Tin::Triangle& triangle = slots.triangles[step.slot];
            for (const VertexId corner : triangle.vertices)
                sum += slots.vertices[corner.index()].z;
            // Always 1, which nobody knows before the triangle is there.
            if (dependent) forward += triangle.marks >> 31U;
            triangle = step.written;
        }
        next += forward;
    }
    for (const Moved& moved : vertices_) {
        if (moved.slot < old_vertices_) {
            slots.vertices[moved.slot] = moved.written;
        } else {
            slots.vertices.push_back(moved.written);
        }
    }
    return sum;
}

std::size_t Walked::bytes_written() const {
    return way_.size() * sizeof(Tin::Triangle) + vertices_.size() * sizeof(Tin::Vertex);
}

}  // namespace tinsmith::bench
