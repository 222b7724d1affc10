// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// Everything that the core can refuse, grouped by hundreds. The same word goes over the wire
/// (see `code_name`); HTTP status numbers are not the core's business.
enum class ErrorCode {
    // 100: coordinates
    CoordinateNotFinite = 101,   ///< NaN or infinite
    CoordinateOutOfRange = 102,  ///< beyond kCoordinateLimit, or nonzero and below kCoordinateFloor
    // 200: meshes
    MeshEmpty = 201,              ///< no triangle
    VertexIndexOutOfRange = 202,  ///< a triangle names a vertex that is not there
    TriangleFlat = 203,           ///< zero area in plan, or a vertex named twice
    EdgeNotManifold = 204,        ///< an edge used by three triangles, or twice in one direction
    VertexUnused = 205,           ///< no triangle uses the vertex
    TriangleClockwise = 206,      ///< clockwise seen from above
    VertexFolded = 207,           ///< the triangles around a vertex overlap
    MeshTooLarge = 208,           ///< more vertices or triangles than the ids can count
    MeshOverlaps = 209,           ///< a part of the mesh lies over another
    TooFewPoints = 211,           ///< fewer than three distinct positions to triangulate
    PointsCollinear = 212,        ///< all positions to triangulate are on one line
    // 300: polygons
    RingTooShort = 301,      ///< fewer than three distinct positions in a ring
    LineTooShort = 302,      ///< fewer than two distinct positions in a line
    ShapeEmpty = 303,        ///< no position at all
    ElevationMissing = 304,  ///< a path with elevations of its own lacks one
    ElevationTwice = 305,    ///< one position with two elevations, also of a terrain's
    // 400: integration
    OutsideMesh = 401,       ///< nothing of the request meets the mesh
    LeavesMesh = 402,        ///< part of the request is outside and the caller asked to reject that
    NotRepresentable = 403,  ///< no mesh of doubles holds the segment within the promised distance
    NoEdgeAlong = 404,       ///< no edge of the mesh lies along the line
    NothingInside = 405,     ///< nothing of the polygon's inside lies on the mesh
    NothingLeft = 406,       ///< a removal would leave no triangle
    // 500: budgets
    CrossingBudget = 501,  ///< more crossings than allowed
    TriangleBudget = 502,  ///< more new triangles than allowed
    Cancelled = 503,       ///< the caller's cancel callback said stop
    StepBudget = 504,      ///< a loop used up its budget: a defect of ours, never the caller's
    IdBudget = 505,        ///< no number is left for another vertex, triangle or facet
    MemoryBudget = 506,    ///< more memory than allowed, as the caller counts it
};

/// The word for a code on the wire, in logs and in tests: "RING_TOO_SHORT".
std::string_view code_name(ErrorCode code);

/// Where in the caller's own request the fault lies. What does not apply is absent.
struct ErrorPlace {
    std::optional<std::size_t> vertex;    ///< vertex index of a mesh
    std::optional<std::size_t> triangle;  ///< triangle index of a mesh
    std::optional<std::size_t> shape;     ///< index into the request's shapes
    std::optional<std::size_t> path;      ///< index into the shape's paths
    std::optional<std::size_t> point;  ///< index into the path's points (segment: its first point)
    std::optional<Point2> position;    ///< plan position
    std::optional<std::size_t> earlier;  ///< the vertex before it that `vertex` contradicts
};

/// One fault: what is wrong, where, and in `detail` what the caller can do.
struct Error {
    ErrorCode code{};
    std::string detail;
    ErrorPlace place;
};

}  // namespace tinsmith::core
