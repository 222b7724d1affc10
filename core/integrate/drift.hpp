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
    /// `first`: what the request's first new vertex will be. `usual`: what rounding one position
    /// puts it off at most, so that no more than that has to be measured only rarely.
    Drift(std::size_t first, double usual) : first_(first), usual_(usual), largest_bend_(usual) {}

    /// Vertices from before the request have lower ids.
    std::size_t first() const { return first_; }
    double usual() const { return usual_; }

    /// Makes room for so many more vertices.
    void expect(std::size_t vertices) { nesting_.reserve(nesting_.size() + vertices); }

    /// How far the vertex is at most, in plan, off the edge between facets that it was put on;
    /// session unit. Zero for vertices that were there before the request, the usual for those of
    /// which no more is known.
    double bend_of(VertexId v) const { return of(v, &OfVertex::bend); }
    /// Remembers the larger of this and what is known. An edge may come to run through a vertex
    /// from before the request: that counts among the largest, but is not kept for the vertex,
    /// which did not move.
    void bend(VertexId v, double bend) {
        largest_bend_ = std::max(largest_bend_, bend);
        if (v.index() < first_) return;
        double& known = at(v).bend;
        known = std::max(known, bend);
    }
    /// At least the usual.
    double largest_bend() const { return largest_bend_; }

    /// How far the vertex is at most from the input segments whose chains it is on; session unit.
    /// Like `bend_of`, for edges inside facets.
    double stray_of(VertexId v) const { return of(v, &OfVertex::stray); }
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
        if (i == nesting_.size()) {
            nesting_.push_back(below + 1);
        } else {
            if (i > nesting_.size()) nesting_.resize(i + 1);
            nesting_[i] = below + 1;
        }
        deepest_ = std::max(deepest_, below + 1);
    }
    std::uint32_t deepest() const { return deepest_; }

  private:
    struct OfVertex {
        double bend = 0.0;  ///< zero: not measured
        double stray = 0.0;
    };

    double of(VertexId v, double OfVertex::*kind) const {
        if (v.index() < first_) return 0.0;
        const std::size_t i = v.index() - first_;
        const double known = i < of_.size() ? of_[i].*kind : 0.0;
        return known > 0.0 ? known : usual_;
    }
    OfVertex& at(VertexId v) {
        const std::size_t i = v.index() - first_;
        if (i >= of_.size()) of_.resize(i + 1);
        return of_[i];
    }

    std::size_t first_;
    double usual_;
    std::vector<OfVertex> of_;  ///< as far as any was measured
    std::vector<std::uint32_t> nesting_;
    double largest_bend_;
    std::uint32_t deepest_ = 0;
};

}  // namespace tinsmith::core
