// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>

#include "core/integrate/shape.hpp"

namespace tinsmith::core {

/// Tells the caller how much of a request's segments is in the mesh, as a share of the whole work.
/// Costs an increment for each segment where nobody asks.
class Progress {
  public:
    /// All segments together are `share` of the work.
    Progress(const std::function<void(double)>& tell, std::span<const Shape> shapes, double share)
        : tell_(tell), share_(share) {
        for (const Shape& shape : shapes) {
            for (const Path& path : shape.paths)
                all_ += path.points.size();
        }
    }

    void begin() { done_ = 0; }
    void end_segment() { ++done_; }
    bool is_asked_for() const { return tell_ != nullptr; }
    /// `of_segment` of the segment at hand is done, from 0 to 1.
    void tell(double of_segment) const {
        const double done = static_cast<double>(done_) + std::clamp(of_segment, 0.0, 1.0);
        tell_(std::min(share_, share_ * done / static_cast<double>(std::max(all_, done_ + 1))));
    }

  private:
    const std::function<void(double)>& tell_;
    double share_;
    std::uint64_t all_ = 0;
    std::uint64_t done_ = 0;
};

}  // namespace tinsmith::core
