// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// Axis-aligned, in plan; may be a single position, or reach to infinity.
struct Box {
    Point2 low;
    Point2 high;

    /// The box around two positions, wider by `slack` on every side.
    static Box around(Point2 p, Point2 q, double slack = 0.0);
    void include(const Box& other);
    bool meets(const Box& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
               other.low.y <= high.y;
    }
};

/// Finds boxes that meet another one, by a uniform grid.
/// Cost: building, the cells that the boxes touch; a query the cells it touches and what they hold.
class BoxGrid {
  public:
    explicit BoxGrid(std::vector<Box> boxes);

    /// The indices of all boxes that meet this one, in order, each once. Until the next call.
    const std::vector<std::uint32_t>& near(const Box& box);

  private:
    struct Cells {
        std::size_t left, right, low, high;
    };
    Cells cells_of(const Box& box) const;
    std::size_t cell_of(double offset, double per_unit) const;

    std::vector<Box> boxes_;
    Box all_;
    std::size_t columns_ = 1;
    double per_x_ = 0.0;
    double per_y_ = 0.0;
    std::vector<std::size_t> first_;  ///< by cell: where its entries begin
    std::vector<std::uint32_t> entries_;
    std::vector<std::uint32_t> found_;
};

}  // namespace tinsmith::core
