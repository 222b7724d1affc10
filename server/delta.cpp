// SPDX-License-Identifier: Apache-2.0
#include "server/delta.hpp"

#include <algorithm>
#include <bit>

namespace tinsmith::server {

namespace {

/// Bit for bit: -0 and 0 are two.
bool same_place(const core::Tin::Vertex& a, const core::Tin::Vertex& b) {
    const auto same = [](double l, double r) {
        return std::bit_cast<std::uint64_t>(l) == std::bit_cast<std::uint64_t>(r);
    };
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

void sort_once(std::vector<std::uint32_t>& slots) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

/// Runs of the slots below `floor`, and of all from there on to `count`.
std::vector<api::SlotRun> runs_of(std::vector<std::uint32_t>& slots, std::size_t floor,
                                  std::size_t count) {
    sort_once(slots);
    std::vector<api::SlotRun> runs;
    const auto add = [&runs](std::uint32_t first, std::uint32_t more) {
        if (!runs.empty() && runs.back().first + runs.back().count == first) {
            runs.back().count += more;
        } else {
            runs.push_back({first, more});
        }
    };
    const std::size_t end = std::min(floor, count);
    for (const std::uint32_t slot : slots) {
        if (slot < end) add(slot, 1);
    }
    if (end < count) add(static_cast<std::uint32_t>(end), static_cast<std::uint32_t>(count - end));
    return runs;
}

/// Counts and versions; what is written is still to come.
api::MeshDelta frame_of(const core::Tin& tin, const DeltaStart& from, std::uint64_t to) {
    api::MeshDelta delta;
    delta.from = from.version;
    delta.to = to;
    delta.old_vertices = static_cast<std::uint32_t>(from.vertices);
    delta.old_triangles = static_cast<std::uint32_t>(from.triangles);
    delta.new_vertices = static_cast<std::uint32_t>(tin.vertex_count());
    delta.new_triangles = static_cast<std::uint32_t>(tin.triangle_count());
    return delta;
}

std::size_t slots_in(const std::vector<api::SlotRun>& runs) {
    std::size_t sum = 0;
    for (const api::SlotRun& run : runs)
        sum += run.count;
    return sum;
}

void copy_slots(const core::Tin& tin, api::MeshDelta& delta) {
    delta.vertices.reserve(slots_in(delta.vertex_runs));
    for (const auto& [first, count] : delta.vertex_runs) {
        for (std::uint32_t v = first; v < first + count; ++v)
            delta.vertices.push_back(tin.vertex({v}).point());
    }
    delta.triangles.reserve(slots_in(delta.triangle_runs));
    for (const auto& [first, count] : delta.triangle_runs) {
        for (std::uint32_t t = first; t < first + count; ++t) {
            const auto& corners = tin.triangle({t}).vertices;
            delta.triangles.push_back({corners[0].value, corners[1].value, corners[2].value});
        }
    }
}

}  // namespace

SlotChanges slot_changes(const core::Tin& tin, const core::Undo& undo) {
    SlotChanges changes{tin.vertex_count(), tin.triangle_count(), {}, {}};
    if (undo.empty()) return changes;
    // From the least count on, slots were made or are gone; with a removal that is the last.
    changes.vertex_floor = std::min(undo.front().vertex_count, tin.vertex_count());
    changes.triangle_floor = std::min(undo.front().triangle_count, tin.triangle_count());
    // A slot stands in several records if several shapes met it. The oldest holds what it was
    // before; where a later one differs as well, the slot is named for nothing, never left out.
    for (const core::UndoRecord& record : undo) {
        for (const auto& [id, old] : record.triangles) {
            if (id.index() < changes.triangle_floor && old.vertices != tin.triangle(id).vertices)
                changes.triangles.push_back(id.value);
        }
        for (const auto& [id, old] : record.vertices) {
            if (id.index() < changes.vertex_floor && !same_place(old, tin.vertex(id)))
                changes.vertices.push_back(id.value);
        }
    }
    sort_once(changes.vertices);
    sort_once(changes.triangles);
    return changes;
}

api::MeshDelta make_whole(const core::Tin& tin, const DeltaStart& from, std::uint64_t to) {
    api::MeshDelta delta = frame_of(tin, from, to);
    delta.whole = true;
    std::vector<std::uint32_t> none;
    delta.vertex_runs = runs_of(none, 0, tin.vertex_count());
    delta.triangle_runs = runs_of(none, 0, tin.triangle_count());
    copy_slots(tin, delta);
    return delta;
}

api::MeshDelta make_delta(const core::Tin& tin, const DeltaStart& from, std::uint64_t to,
                          std::span<const std::shared_ptr<const SlotChanges>> changes) {
    std::size_t vertex_floor = from.vertices;
    std::size_t triangle_floor = from.triangles;
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> triangles;
    for (const auto& change : changes) {
        vertex_floor = std::min(vertex_floor, change->vertex_floor);
        triangle_floor = std::min(triangle_floor, change->triangle_floor);
        vertices.insert(vertices.end(), change->vertices.begin(), change->vertices.end());
        triangles.insert(triangles.end(), change->triangles.begin(), change->triangles.end());
    }
    api::MeshDelta delta = frame_of(tin, from, to);
    delta.vertex_runs = runs_of(vertices, vertex_floor, tin.vertex_count());
    delta.triangle_runs = runs_of(triangles, triangle_floor, tin.triangle_count());
    const std::size_t bytes =
        api::delta_bytes({delta.vertex_runs.size(), slots_in(delta.vertex_runs),
                          delta.triangle_runs.size(), slots_in(delta.triangle_runs)});
    if (bytes >= api::delta_bytes({1, tin.vertex_count(), 1, tin.triangle_count()})) {
        return make_whole(tin, from, to);
    }
    copy_slots(tin, delta);
    return delta;
}

}  // namespace tinsmith::server
