// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/integrate/improve.hpp"
#include "core/integrate/march.hpp"
#include "core/integrate/measure.hpp"
#include "core/integrate/stopwatch.hpp"
#include "core/integrate/way.hpp"
#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// Integrates one shape: marches its paths, swaps within facets on the way, sets the elevations
/// that the paths bring. What it does is in the surgery, which the caller commits or rolls back.
class ShapeIntegration {
  public:
    ShapeIntegration(Surgery& surgery, const IntegrateOptions& options, const MarchLimits& limits,
                     Drift& drift, Stopwatch& watch, StageTimes& times, Progress& progress)
        : surgery_(surgery),
          options_(options),
          watch_(watch),
          times_(times),
          drift_(drift),
          progress_(progress),
          improver_(surgery),
          march_(surgery, options, limits, drift,
                 options.improve == Improve::Strict ? &improver_ : nullptr) {}

    /// False: stopped, see `error`.
    bool run(const Shape& shape, std::size_t index, const Ways& ways);

    const Error& error() { return *march_.error(); }
    const MarchTally& tally() const { return march_.tally(); }
    bool is_delicate() const { return march_.is_delicate(); }
    /// Vertices whose surroundings the march changed; kept for swaps across facets only.
    std::vector<VertexId>& changed() { return changed_; }
    /// Vertices whose elevation the shape set, in order.
    const std::vector<VertexId>& set_vertices() const { return set_vertices_; }
    /// What was done. Certifies it: to be asked once, at the end.
    ShapeReport report();

  private:
    bool run(std::size_t index, const Path& path, const Way& way);
    bool run_reversed(std::size_t index, const Path& path, const Way& way);
    void improve(std::size_t waiting);
    bool set_elevations();
    double certify(const Measurement& measured);

    Surgery& surgery_;
    const IntegrateOptions& options_;
    Stopwatch& watch_;
    StageTimes& times_;
    Drift& drift_;
    Progress& progress_;
    Improver improver_;
    March march_;
    std::vector<VertexId> changed_;
    std::vector<VertexId> set_vertices_;
    double max_elevation_change_ = 0.0;
};

}  // namespace tinsmith::core
