// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/integrate/options.hpp"
#include "core/integrate/replaced.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// A segment of the request, of nonzero length, from point `index` of its path to the next.
struct InputSegment {
    std::size_t shape = 0;
    std::size_t path = 0;
    std::size_t index = 0;
    Point2 a;
    Point2 b;
};

/// A request as it has been marched, before swaps across facets.
struct Attempt {
    const Tin& tin;
    const Replaced& replaced;
    std::span<const Shape> shapes;
    std::span<const ShapeReport> reports;
    const IntegrateOptions& options;
    double reach;  ///< of rounding: 4 ulp of the mesh's largest coordinate
};

/// A guarantee that the attempt does not keep, and the place in the request.
struct BrokenPromise {
    std::size_t shape = 0;
    std::size_t path = 0;
    std::size_t point = 0;
    Point2 position;
};

/// Where the attempt breaks what the report promises, if anywhere: chains cover their segments, no
/// vertex lacks a reason, the surface stays, elevations are those of a path. Where rounding decides
/// everything a march may go wrong; what this finds in order is in order, whatever the march did.
/// It knows nothing of the march. Cost: about linear in the request and in what it changed.
std::optional<BrokenPromise> find_broken_promise(const Attempt& attempt);

// The parts, each in a file of its own.

/// G3: each segment is covered by edges of its chains wherever it is on the mesh, their vertices
/// within the larger of snap and `reach`; constraints from before go where they went.
std::optional<BrokenPromise> find_lost_chain(const Attempt& attempt,
                                             std::span<const InputSegment> segments);
/// G8: no more new vertices at a place than points of the request and crossings there.
std::optional<BrokenPromise> find_needless_vertex(const Attempt& attempt,
                                                  std::span<const InputSegment> segments);
/// G2: the surface is where it was, but for elevations that the request brings.
std::optional<BrokenPromise> find_moved_surface(const Attempt& attempt,
                                                std::span<const InputSegment> segments);
/// Chains along paths with elevations have these.
std::optional<BrokenPromise> find_wrong_elevation(const Attempt& attempt,
                                                  std::span<const InputSegment> segments);

/// The constrained edges that the chains are made of now, lower vertex first, in order, each once;
/// nothing where a chain is broken.
std::optional<std::vector<Replaced::Edge>> chain_edges(const Attempt& attempt);
/// How far a chain may be from its segment.
double chain_reach(const Attempt& attempt);

}  // namespace tinsmith::core
