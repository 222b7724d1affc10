// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/types/point.hpp"
#include "tests/cgal/hull_filling.hpp"

namespace tinsmith::cgal {

/// Triangles of one facet: a plane, given by three of its points, and what lies in it by its plan
/// positions. Edges are pairs of indices into `points`.
struct Facet {
    std::array<core::Point3, 3> plane;
    std::vector<core::Point2> points;
    std::vector<Triple> triangles;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> outline;  ///< each once
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fixed;    ///< edges inside that stay
};

/// The constrained Delaunay triangulation of the facet's points in its plane, within the outline,
/// by CGAL: circles are those of the plane, decided with rational numbers.
std::vector<Triple> constrained_delaunay(const Facet& facet);

/// The smallest angle in the plane of each of the triangles, in degrees, from the smallest.
std::vector<double> smallest_angles(const Facet& facet, const std::vector<Triple>& triangles);

}  // namespace tinsmith::cgal
