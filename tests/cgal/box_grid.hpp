// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::cgal {

struct Box {
    core::Point2 low;
    core::Point2 high;

    static Box around(core::Point2 a, core::Point2 b, double margin);
};

/// Boxes in a grid of buckets: which of them may meet a box.
class BoxGrid {
  public:
    explicit BoxGrid(const std::vector<Box>& boxes);

    /// The boxes that share a bucket with the box, each once, in order.
    std::vector<std::uint32_t> near(const Box& box) const;

  private:
    std::size_t cell(double value, double low, double high) const;

    Box bounds_;
    std::size_t columns_;
    std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace tinsmith::cgal
