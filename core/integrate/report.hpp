// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/types/ids.hpp"
#include "core/types/point.hpp"

namespace tinsmith::core {

/// A stretch of an input path that lies outside the mesh and was skipped.
struct OutsidePart {
    std::size_t path = 0;        ///< index into the shape's paths
    std::vector<Point2> points;  ///< from where the path leaves the mesh to where it comes back
};

/// A stretch of an input path as it lies in the mesh: consecutive vertices are joined by
/// constrained edges, as they were when the operation ended. Later operations may split those;
/// `Tin::constraint_splits` says where. They are told by name (`Tin::name`), which stays true when
/// a removal renumbers. A closed path wholly on the mesh ends at its first vertex.
struct Chain {
    std::size_t path = 0;  ///< index into the shape's paths
    std::vector<VertexId> vertices;
};

/// Smallest angles (3D, degrees) of the triangles an operation touched.
struct AngleSummary {
    double before = 0.0;     ///< smallest of the touched triangles, before
    double after = 0.0;      ///< smallest of the triangles in their place, after
    double p1_before = 0.0;  ///< first percentile, before
    double p1_after = 0.0;   ///< first percentile, after
};

/// What integrating one shape did and what it can promise.
struct ShapeReport {
    std::uint64_t segments = 0;   ///< input segments of nonzero length
    std::uint64_t crossings = 0;  ///< proper crossings with edges of the mesh before the request
    std::uint64_t vertices_added = 0;
    std::uint64_t triangles_added = 0;
    std::uint64_t edges_swapped = 0;
    std::vector<OutsidePart> outside;
    std::vector<Chain> chains;            ///< what the mesh holds of the shape
    double max_vertical_deviation = 0.0;  ///< certified bound, see `integrate`
    double max_plan_deviation = 0.0;      ///< chain vertices to their input segment, measured
    double max_elevation_change = 0.0;    ///< by elevations that the paths brought, measured
    AngleSummary smallest_angle_deg;
};

/// Milliseconds by the caller's clock; disjoint, their sum is the whole edit.
struct StageTimes {
    double locate = 0.0;
    double integrate = 0.0;
    double improve = 0.0;
};

struct Report {
    std::vector<ShapeReport> shapes;  ///< one for each input shape, in order
    StageTimes time_ms;               ///< zero where the caller gave no clock
};

}  // namespace tinsmith::core
