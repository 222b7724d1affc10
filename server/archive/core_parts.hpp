// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/edit/region_edit.hpp"
#include "core/integrate/integrator.hpp"
#include "core/integrate/lock.hpp"
#include "core/mesh/repair.hpp"
#include "core/mesh/tin_state.hpp"
#include "core/mesh/undo_record.hpp"
#include "server/archive/packing.hpp"

// What the core's types are made of.

namespace tinsmith::server {

template <>
struct IsPlain<core::Point2> : std::true_type {};
template <>
struct IsPlain<core::Point3> : std::true_type {};
template <>
struct IsPlain<core::Bounds> : std::true_type {};
template <>
struct IsPlain<core::AngleSummary> : std::true_type {};
template <>
struct IsPlain<core::StageTimes> : std::true_type {};
template <>
struct IsPlain<core::Plane> : std::true_type {};
template <>
struct IsPlain<core::ElevationEdit::Offset> : std::true_type {};
template <>
struct IsPlain<core::EditReport> : std::true_type {};
template <>
struct IsPlain<core::TinState::BoundaryBox> : std::true_type {};
template <>
struct IsPlain<core::IdLimits> : std::true_type {};

static_assert(sizeof(core::Bounds) == 6 * sizeof(double));
static_assert(sizeof(core::AngleSummary) == 4 * sizeof(double));
static_assert(sizeof(core::StageTimes) == 3 * sizeof(double));
static_assert(sizeof(core::Plane) == 5 * sizeof(double));
static_assert(sizeof(core::EditReport) == 14 * sizeof(double));
static_assert(sizeof(core::TinState::BoundaryBox) == 4 * sizeof(double));

template <>
struct Parts<core::Tin::Vertex> {
    static void each(auto& vertex, auto visit) {
        auto& [x, y, z, triangle] = vertex;
        visit(x, y, z, triangle);
    }
};

template <>
struct Parts<core::GoneEnd> {
    static void each(auto& end, auto visit) {
        auto& [name, plan] = end;
        visit(name, plan);
    }
};

template <>
struct Parts<core::TinState::BoundaryEntry> {
    static void each(auto& entry, auto visit) {
        auto& [vertex, p, q] = entry;
        visit(vertex, p, q);
    }
};

template <>
struct Parts<core::TinState::BoundaryChange> {
    static void each(auto& change, auto visit) {
        auto& [entries, halvings, renamed, before] = change;
        visit(entries, halvings, renamed, before);
    }
};

template <>
struct Parts<core::TinState::BoundaryNode> {
    static void each(auto& node, auto visit) {
        auto& [halves, by_y, entries] = node;
        visit(halves, by_y, entries);
    }
};

template <>
struct Parts<core::BoundaryIndex> {
    static void each(auto& index, auto visit) { core::TinState::each_of_boundary(index, visit); }
};

template <>
struct Parts<core::Tin> {
    static void each(auto& tin, auto visit) { core::TinState::each(tin, visit); }
};

template <>
struct Parts<core::RemovalRecord> {
    static void each(auto& record, auto visit) {
        auto& [was_renumbered, names, named_splits, splits, gone_ends, built, components, hints,
               boundary] = record;
        visit(was_renumbered, names, named_splits, splits, gone_ends, built, components, hints,
              boundary);
    }
};

template <>
struct Parts<core::UndoRecord> {
    static void each(auto& record, auto visit) {
        auto& [vertex_count, triangle_count, boundary_changes, split_count, next_facet, next_name,
               facet_error, bounds, moved_vertices, triangles, vertices, removal] = record;
        visit(vertex_count, triangle_count, boundary_changes, split_count, next_facet, next_name,
              facet_error, bounds, moved_vertices, triangles, vertices, removal);
    }
};

template <>
struct Parts<core::Path> {
    static void each(auto& path, auto visit) {
        auto& [points, closed, elevations] = path;
        visit(points, closed, elevations);
    }
};

template <>
struct Parts<core::Shape> {
    static void each(auto& shape, auto visit) {
        auto& [paths] = shape;
        visit(paths);
    }
};

template <>
struct Parts<core::OutsidePart> {
    static void each(auto& part, auto visit) {
        auto& [path, points] = part;
        visit(path, points);
    }
};

template <>
struct Parts<core::Chain> {
    static void each(auto& chain, auto visit) {
        auto& [path, vertices] = chain;
        visit(path, vertices);
    }
};

template <>
struct Parts<core::ShapeReport> {
    static void each(auto& report, auto visit) {
        auto& [segments, crossings, vertices, triangles, swapped, outside, chains, vertical, plan,
               change, angles] = report;
        visit(segments, crossings, vertices, triangles, swapped, outside, chains, vertical, plan,
              change, angles);
    }
};

template <>
struct Parts<core::Report> {
    static void each(auto& report, auto visit) {
        auto& [shapes, time_ms] = report;
        visit(shapes, time_ms);
    }
};

/// Without budgets, clock and cancel, which were the request's alone.
template <>
struct Parts<core::IntegrateOptions> {
    static void each(auto& options, auto visit) {
        auto& [improve, max_deviation, outside, on_crossing, snap, lock, max_crossings,
               max_new_triangles, ids, cancelled, progress, clock_ms, walk_seed] = options;
        visit(improve, max_deviation, outside, on_crossing, snap, lock, ids, walk_seed);
    }
};

template <>
struct Parts<core::LockReport> {
    static void each(auto& report, auto visit) {
        auto& [edges, changed, length, without_edge] = report;
        visit(edges, changed, length, without_edge);
    }
};

template <>
struct Parts<core::Strip> {
    static void each(auto& strip, auto visit) {
        auto& [kind, width, ring, border] = strip;
        visit(kind, width, ring, border);
    }
};

template <>
struct Parts<core::ElevationEdit> {
    static void each(auto& edit, auto visit) {
        auto& [change, strip] = edit;
        visit(change, strip);
    }
};

template <>
struct Parts<core::SmoothEdit> {
    static void each(auto& edit, auto visit) {
        auto& [passes, moves_border] = edit;
        visit(passes, moves_border);
    }
};

template <>
struct Parts<core::TrimEdit> {
    static void each(auto& edit, auto visit) {
        auto& [keeps_inside] = edit;
        visit(keeps_inside);
    }
};

template <>
struct Parts<core::Repair> {
    static void each(auto& repair, auto visit) {
        auto& [kind, count, indices] = repair;
        visit(kind, count, indices);
    }
};

}  // namespace tinsmith::server
