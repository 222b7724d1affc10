// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/integrate/box_grid.hpp"

namespace tinsmith::core {

/// Finds boxes that meet another one, whatever their sizes: packed, halved in turn by x and y.
/// Memory: linear, long thin boxes included, which fill a grid's cells by the million.
/// Cost: building n log^2 n; a query the logarithm and about what it finds, for boxes that do not
/// overlap much.
class BoxTree {
  public:
    explicit BoxTree(std::vector<Box> boxes);

    /// Puts the indices of all boxes that meet this one into `found`, in order.
    void near(const Box& box, std::vector<std::uint32_t>& found) const;

  private:
    struct Node {
        Box box;
        std::uint32_t first = 0;   ///< in `order_`
        std::uint32_t last = 0;    ///< one past
        std::uint32_t halves = 0;  ///< the lower one, the upper follows; 0: a leaf
    };

    std::vector<Box> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace tinsmith::core
