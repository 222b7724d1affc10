// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// What rounding did to the vertices of a request, so that it can be certified. One lives for a
/// whole request.
class Drift {
  public:
    /// `first`: what the request's first new vertex will be.
    explicit Drift(std::size_t first) : first_(first) {}

    /// Makes room for so many more vertices.
    void expect(std::size_t vertices) { nesting_.reserve(nesting_.size() + vertices); }

    /// How far the vertex is, in plan, off the edge between facets that it was put on, where that
    /// is more than the rounding of one position; session unit. Zero for vertices that were there
    /// before the request.
    double bend_of(VertexId v) const { return knows(v) ? of_[v.index() - first_].bend : 0.0; }
    /// Remembers the larger of this and what is known. An edge may come to run through a vertex
    /// from before the request: that counts among the largest, but is not kept for the vertex,
    /// which did not move.
    void bend(VertexId v, double bend) {
        largest_bend_ = std::max(largest_bend_, bend);
        if (v.index() < first_) return;
        double& known = at(v).bend;
        known = std::max(known, bend);
    }
    double largest_bend() const { return largest_bend_; }

    /// How far the vertex is from the input segments whose chains it is on, where that is more than
    /// the rounding of one position; session unit. Like `bend_of`, for edges inside facets.
    double stray_of(VertexId v) const { return knows(v) ? of_[v.index() - first_].stray : 0.0; }
    void stray(VertexId v, double distance) {
        if (v.index() < first_) return;
        double& known = at(v).stray;
        known = std::max(known, distance);
    }

    /// How often elevations were interpolated one from the other to give the vertex its own.
    std::uint32_t nesting_of(VertexId v) const {
        // Vertices from before the request wrap around to numbers past the end.
        const std::size_t i = v.index() - first_;
        return i < nesting_.size() ? nesting_[i] : 0;
    }
    /// A new vertex took its elevation from others, of which the deepest is given.
    void nest(VertexId v, std::uint32_t below) {
        const std::size_t i = v.index() - first_;
        if (i >= nesting_.size()) nesting_.resize(i + 1);
        nesting_[i] = below + 1;
        deepest_ = std::max(deepest_, below + 1);
    }
    std::uint32_t deepest() const { return deepest_; }

  private:
    struct OfVertex {
        double bend = 0.0;
        double stray = 0.0;
    };

    bool knows(VertexId v) const { return v.index() >= first_ && v.index() - first_ < of_.size(); }
    OfVertex& at(VertexId v) {
        const std::size_t i = v.index() - first_;
        if (i >= of_.size()) of_.resize(i + 1);
        return of_[i];
    }

    std::size_t first_;
    std::vector<OfVertex> of_;  ///< as far as any is off anything
    std::vector<std::uint32_t> nesting_;
    double largest_bend_ = 0.0;
    std::uint32_t deepest_ = 0;
};

}  // namespace tinsmith::core
