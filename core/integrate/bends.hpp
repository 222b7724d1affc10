// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// How far vertices that a request put on edges between facets are off those edges in plan, where
/// that is more than the rounding of one position. Session unit. One lives for a whole request.
class Bends {
  public:
    /// Zero for vertices that were there before the request, or are on the edge.
    double of(VertexId v) const {
        const std::size_t i = v.index() - first_;
        return v.index() >= first_ && i < bends_.size() ? bends_[i] : 0.0;
    }
    /// Remembers the larger of this and what is known. Vertices from before the request do not
    /// move: theirs is not kept.
    void set(VertexId v, double bend) {
        if (v.index() < first_) return;
        const std::size_t i = v.index() - first_;
        if (i >= bends_.size()) bends_.resize(i + 1, 0.0);
        bends_[i] = std::max(bends_[i], bend);
        largest_ = std::max(largest_, bend);
    }
    double largest() const { return largest_; }

    /// `first`: what the request's first new vertex will be.
    explicit Bends(std::size_t first) : first_(first) {}

  private:
    std::size_t first_;
    std::vector<double> bends_;
    double largest_ = 0.0;
};

}  // namespace tinsmith::core
