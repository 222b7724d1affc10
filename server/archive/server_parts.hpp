// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/archive/core_parts.hpp"
#include "server/session.hpp"

// What a session's own types are made of.

namespace tinsmith::server {

template <>
struct Parts<SessionFacts> {
    static void each(auto& facts, auto visit) {
        auto& [id, birth, name, crs, unit, repairs, notes] = facts;
        visit(id, birth, name, crs, unit, repairs, notes);
    }
};

template <>
struct Parts<PolygonOrigin> {
    static void each(auto& origin, auto visit) {
        auto& [client_id, properties, type, paths, polygon_starts] = origin;
        visit(client_id, properties, type, paths, polygon_starts);
    }
};

template <>
struct Parts<PolygonsOperation> {
    static void each(auto& operation, auto visit) {
        auto& [shapes, origins, ids, winding, options] = operation;
        visit(shapes, origins, ids, winding, options);
    }
};

template <>
struct Parts<LocksOperation> {
    static void each(auto& operation, auto visit) {
        auto& [shapes, reach, locked] = operation;
        visit(shapes, reach, locked);
    }
};

template <>
struct Parts<LocksDone> {
    static void each(auto& done, auto visit) {
        auto& [locked, paths] = done;
        visit(locked, paths);
    }
};

template <>
struct Parts<api::EditAnswer> {
    static void each(auto& answer, auto visit) {
        auto& [kind, polygon, moves_border, rim, taper, report] = answer;
        visit(kind, polygon, moves_border, rim, taper, report);
    }
};

template <>
struct Parts<EditOperation> {
    static void each(auto& operation, auto visit) {
        auto& [asked, edit] = operation;
        visit(asked, edit);
    }
};

template <>
struct Parts<SlotChanges> {
    static void each(auto& changes, auto visit) {
        auto& [vertex_floor, triangle_floor, vertices, triangles] = changes;
        visit(vertex_floor, triangle_floor, vertices, triangles);
    }
};

template <>
struct Parts<Applied> {
    static void each(auto& applied, auto visit) {
        auto& [version, operation, report, locks, answer, undo, written, lasting, record] = applied;
        visit(version, operation, report, locks, answer, undo, written, lasting, record);
    }
};

template <>
struct Parts<Rerun> {
    static void each(auto& rerun, auto visit) {
        auto& [version, operation] = rerun;
        visit(version, operation);
    }
};

template <>
struct Parts<Exchange> {
    static void each(auto& exchange, auto visit) {
        auto& [first, removed, added] = exchange;
        visit(first, removed, added);
    }
};

template <>
struct Parts<Change> {
    static void each(auto& change, auto visit) {
        auto& [version, kind, of, polygons, report, answer, locks, vertices, triangles, written,
               step, told_bytes, lone_bytes] = change;
        visit(version, kind, of, polygons, report, answer, locks, vertices, triangles, written,
              step, told_bytes, lone_bytes);
    }
};

template <>
struct Parts<Edit> {
    static void each(auto& edit, auto visit) {
        auto& [version, first, removed, added, polygons, removed_bytes, added_bytes] = edit;
        visit(version, first, removed, added, polygons, removed_bytes, added_bytes);
    }
};

template <>
struct Parts<History::Settled> {
    static void each(auto& settled, auto visit) {
        auto& [operation, report] = settled;
        visit(operation, report);
    }
};

template <>
struct Parts<History> {
    static void each(auto& history, auto visit) { History::each(history, visit); }
};

template <>
struct Parts<PerformAsked> {
    static void each(auto& asked, auto visit) {
        auto& [kind, operation, polygons] = asked;
        visit(kind, operation, polygons);
    }
};

template <>
struct Parts<UndoAsked> {
    static void each(auto&, auto visit) { visit(); }
};

template <>
struct Parts<RedoAsked> {
    static void each(auto&, auto visit) { visit(); }
};

template <>
struct Parts<RemovalAsked> {
    static void each(auto& asked, auto visit) {
        auto& [polygon, cascade] = asked;
        visit(polygon, cascade);
    }
};

template <>
struct Parts<SessionCounts> {
    static void each(auto& counts, auto visit) {
        auto& [version, vertices, triangles, bounds, polygons, memory_bytes, mesh_bytes] = counts;
        visit(version, vertices, triangles, bounds, polygons, memory_bytes, mesh_bytes);
    }
};

}  // namespace tinsmith::server
