// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/mesh/tin.hpp"
#include "core/types/point.hpp"
#include "core/types/result.hpp"

namespace tinsmith::core {

/// One point of a profile.
struct ProfilePoint {
    enum class Kind : std::uint8_t {
        Input,   ///< a vertex of the line, whatever is under it
        Edge,    ///< the line crosses the inside of an edge
        Vertex,  ///< it goes through a vertex of the mesh
    };
    double distance = 0.0;  ///< along the line from its start, in plan
    Point3 position;        ///< on the surface
    TriangleId triangle;    ///< a triangle at the point, on the line's way where it has one
    Kind kind = Kind::Input;
};

/// A part of the line that lies in the mesh without a gap. Between two points that follow each
/// other the surface is straight. Distances never fall.
struct Stretch {
    std::vector<ProfilePoint> points;  ///< one only where the line's vertex just touches the mesh
};

struct Profile {
    std::vector<Stretch> stretches;  ///< in order along the line; what is between them is outside
    double length = 0.0;             ///< of the line, in plan
    std::uint64_t crossings = 0;     ///< points that are not the line's own vertices
};

struct ProfileLimits {
    std::uint64_t max_crossings = UINT64_MAX;
    std::function<bool()> cancelled = {};  ///< asked now and then; true stops the work
};

/// The surface along a line: a point at its start, wherever it crosses an edge or meets a vertex of
/// the mesh, at each vertex of its own, and at its end. All in the session's unit.
///
/// Laws: exact predicates on the input alone say what the line meets and in which order, so nothing
/// is met twice or missed, along edges and through vertices too; positions and elevations are right
/// to rounding. Parts outside the mesh (concave outline, holes, between components) end a stretch
/// and begin another; between two vertices of the line so do places where parts of the mesh touch
/// without sharing an edge.
/// Vertices of the line that repeat the one before count once. The mesh is only read.
/// Errors: fewer than two different positions; coordinates out of range; the budget of crossings;
/// cancelled.
/// Cost: linear in crossings, with the degrees of vertices met and the boundary near the line.
Result<Profile> profile_along(const Tin& tin, std::span<const Point2> line,
                              const ProfileLimits& limits = {});

}  // namespace tinsmith::core
