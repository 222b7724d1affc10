// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"
#include "tests/support/surface_oracle.hpp"

namespace tinsmith::test {

/// What an operation was and did, for the checks below.
struct Operation {
    const SurfaceOracle& before;
    const core::Tin& after;
    std::span<const core::Shape> shapes;
    const core::Report& report;
};

/// Each returns what is broken, in words; empty when the guarantee holds.
/// G1: every law of the mesh, by `check_tin`.
std::vector<std::string> check_valid(const core::Tin& tin);
/// G2: vertical distance of the surfaces at all vertices of both and at `samples` random positions.
std::vector<std::string> check_shape_kept(const Operation& op, std::size_t samples,
                                          std::uint64_t seed);
/// G3: constrained edges within rounding of each input segment cover it, where it is on the mesh.
std::vector<std::string> check_integrated(const Operation& op);
/// G8: new vertices are the distinct input vertices and crossings on the mesh, no more, no fewer.
/// Positions that are one to within rounding may be one vertex or two. `forced`: so many more are
/// let pass at one place, for meshes whose triangles are some ulps wide.
std::vector<std::string> check_economical(const Operation& op, std::size_t forced);
/// All of them.
std::vector<std::string> check_guarantees(const Operation& op, std::size_t samples,
                                          std::uint64_t seed);

/// 4 ulp of the mesh's largest plan coordinate.
double rounding_reach(const SurfaceOracle& mesh);

}  // namespace tinsmith::test
