// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/types/mesh_data.hpp"
#include "tests/cgal/box_grid.hpp"

namespace tinsmith::cgal {

struct Line {
    core::Point2 a;
    core::Point2 b;
};

/// All segments of nonzero length, path after path.
std::vector<Line> segments_of(const core::Shape& shape);

/// How two segments meet, exactly.
enum class Meeting : std::uint8_t {
    Apart,
    Touch,  ///< they have points in common, but an end of one is on the other
    Cross,  ///< properly: the ends of each strictly on either side of the other
};
Meeting meeting(const Line& one, const Line& other);

/// Whether p is within the distance of the line segment, decided with rational numbers.
bool is_within(core::Point2 p, const Line& line, double distance);

/// A segment of a shape and an edge of a mesh, or, for a self-crossing, a later segment of the
/// shape.
struct Crossing {
    std::uint32_t segment;
    std::uint32_t other;

    friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

struct Crossings {
    std::set<Crossing> edges;
    std::set<Crossing> self;
    std::vector<core::Point2> unexplained;  ///< new vertices that are on no edge or on no segment
};

/// Which segment crosses which edge: by exact predicates, and as an implementation has it.
class CrossingOracle {
  public:
    CrossingOracle(const core::MeshData& mesh, const core::Shape& shape);

    const Line& segment(std::uint32_t i) const { return segments_[i]; }
    const Line& edge(std::uint32_t i) const { return edges_[i]; }
    /// The edge's ends, as "12-345".
    std::string edge_name(std::uint32_t i) const;
    /// ulp of the mesh's largest plan coordinate.
    double ulp() const { return ulp_; }

    /// All proper crossings.
    const Crossings& exact() const { return exact_; }

    /// What the vertices that an implementation has beyond the mesh's stand for. A vertex at a
    /// point of the shape or of the mesh stands for nothing. Another stands for the proper
    /// crossings of those segments and edges that it is near to; where there is none, for the
    /// pairs of those, all of them.
    Crossings of_vertices(const std::vector<core::Point2>& vertices, double near) const;

    /// Why rounding may take the crossing for something else: "edge-end" where an end of the edge
    /// is within 2 ulp of the segment, "segment-end" where an end of the segment is within 2 ulp of
    /// the edge, else "none".
    std::string excuse(const Crossing& crossing) const;

  private:
    std::vector<std::uint32_t> lines_near(const std::vector<Line>& lines, const BoxGrid& grid,
                                          core::Point2 p, double near) const;

    std::vector<Line> segments_;
    std::vector<Line> edges_;
    std::vector<std::array<std::uint32_t, 2>> edge_ends_;
    std::vector<core::Point2> known_;  ///< points of mesh and shape, sorted
    double ulp_ = 0.0;
    BoxGrid segment_grid_;
    BoxGrid edge_grid_;
    Crossings exact_;
};

}  // namespace tinsmith::cgal
