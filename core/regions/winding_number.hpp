// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::core {

/// A directed segment of a closed line.
struct DirectedSegment {
    Point2 from;
    Point2 to;
};

/// How often closed lines run around a position, counter-clockwise less clockwise: exact.
/// Holds the segments by rows of their elevation in plan (y), so that a position asks only those
/// of its own row. Cost: building linear; a question the segments of one row, on compact rings
/// far fewer than all.
class WindingNumber {
  public:
    /// Requires: as many segments end at each position as start there, so that the lines are
    /// closed. Their order does not matter.
    explicit WindingNumber(const std::vector<DirectedSegment>& segments);

    /// Requires: the position is on none of the segments; else one side or the other counts.
    int around(Point2 p) const;
    /// Whether no segment is within the distance of the position, to within rounding of the
    /// distance. Cost: the segments of the rows that are.
    bool is_clear(Point2 p, double distance) const;

  private:
    std::size_t row(double y) const;

    double low_ = 0.0;
    double rows_per_y_ = 0.0;
    std::vector<std::size_t> first_;         ///< where each row begins, and the end of the last
    std::vector<DirectedSegment> segments_;  ///< row by row
};

}  // namespace tinsmith::core
