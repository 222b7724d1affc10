// SPDX-License-Identifier: Apache-2.0
#include "core/types/error.hpp"

namespace tinsmith::core {

std::string_view code_name(ErrorCode code) {
    switch (code) {
        case ErrorCode::CoordinateNotFinite:
            return "COORDINATE_NOT_FINITE";
        case ErrorCode::CoordinateOutOfRange:
            return "COORDINATE_OUT_OF_RANGE";
        case ErrorCode::MeshEmpty:
            return "MESH_EMPTY";
        case ErrorCode::VertexIndexOutOfRange:
            return "VERTEX_INDEX_OUT_OF_RANGE";
        case ErrorCode::TriangleFlat:
            return "TRIANGLE_FLAT";
        case ErrorCode::EdgeNotManifold:
            return "EDGE_NOT_MANIFOLD";
        case ErrorCode::VertexUnused:
            return "VERTEX_UNUSED";
        case ErrorCode::TriangleClockwise:
            return "TRIANGLE_CLOCKWISE";
        case ErrorCode::VertexFolded:
            return "VERTEX_FOLDED";
        case ErrorCode::MeshTooLarge:
            return "MESH_TOO_LARGE";
        case ErrorCode::MeshOverlaps:
            return "MESH_OVERLAPS";
        case ErrorCode::TooFewPoints:
            return "TOO_FEW_POINTS";
        case ErrorCode::PointsCollinear:
            return "POINTS_COLLINEAR";
        case ErrorCode::RingTooShort:
            return "RING_TOO_SHORT";
        case ErrorCode::LineTooShort:
            return "LINE_TOO_SHORT";
        case ErrorCode::ShapeEmpty:
            return "SHAPE_EMPTY";
        case ErrorCode::ElevationMissing:
            return "ELEVATION_MISSING";
        case ErrorCode::ElevationTwice:
            return "ELEVATION_TWICE";
        case ErrorCode::OutsideMesh:
            return "OUTSIDE_MESH";
        case ErrorCode::LeavesMesh:
            return "LEAVES_MESH";
        case ErrorCode::NotRepresentable:
            return "NOT_REPRESENTABLE";
        case ErrorCode::NoEdgeAlong:
            return "NO_EDGE_ALONG";
        case ErrorCode::NothingInside:
            return "NOTHING_INSIDE";
        case ErrorCode::NothingLeft:
            return "NOTHING_LEFT";
        case ErrorCode::CrossingBudget:
            return "CROSSING_BUDGET";
        case ErrorCode::TriangleBudget:
            return "TRIANGLE_BUDGET";
        case ErrorCode::Cancelled:
            return "CANCELLED";
        case ErrorCode::StepBudget:
            return "STEP_BUDGET";
        case ErrorCode::IdBudget:
            return "ID_BUDGET";
        case ErrorCode::MemoryBudget:
            return "MEMORY_BUDGET";
    }
    return "UNKNOWN";
}

}  // namespace tinsmith::core
