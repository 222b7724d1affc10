// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"
#include "tests/cgal/peer.hpp"

namespace tinsmith::bench {

/// One mesh, as each of the three holds it.
struct Bases {
    explicit Bases(const core::MeshData& mesh);

    core::Tin tin;
    cgal::Peer points;     ///< recipe a
    cgal::Peer triangles;  ///< recipe b
};

/// One polygon into one mesh, again and again, each time into a copy made just before: Tinsmith and
/// recipe a, Tinsmith and recipe b. So each run follows one of the other program, and neither finds
/// its own code, or branches just taken, in the processor's caches. Times in milliseconds; copying,
/// and draping for the peers, are not in them.
struct PairedRuns {
    std::uint64_t crossings = 0;  ///< with edges of the mesh, as Tinsmith reports them
    std::uint64_t added = 0;      ///< vertices, by Tinsmith
    std::uint64_t added_points = 0;
    std::uint64_t added_triangles = 0;
    std::vector<double> ours;  ///< two of each turn
    std::vector<double> points;
    std::vector<double> triangles;
    double improving = 0.0;  ///< share of Tinsmith's time that goes into swaps for better triangles
};

/// Throws where Tinsmith refuses the shape. Requires: it is wholly on the mesh.
PairedRuns run_paired(const Bases& bases, const core::Shape& shape, int runs);

/// A table of such results.
void print_heading();
void print_row(const std::string& mesh, const std::string& polygon, std::size_t segments,
               const PairedRuns& runs);

}  // namespace tinsmith::bench
