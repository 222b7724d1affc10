// SPDX-License-Identifier: Apache-2.0
#include "core/regions/winding_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/integrate/distance.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

WindingNumber::WindingNumber(const std::vector<DirectedSegment>& segments) : first_{0, 0} {
    if (segments.empty()) return;
    low_ = segments.front().from.y;
    double high = low_;
    double climb = 0.0;
    for (const auto& [from, to] : segments) {
        low_ = std::min({low_, from.y, to.y});
        high = std::max({high, from.y, to.y});
        climb += std::fabs(to.y - from.y);
    }
    // A segment is in each row that it touches: with so many rows they are in three each at most,
    // taken together.
    const double rows =
        climb > 0.0 ? std::clamp(static_cast<double>(segments.size()) * ((high - low_) / climb),
                                 1.0, 0x1p20)
                    : 1.0;
    const auto count = static_cast<std::size_t>(rows);
    // Finite, however flat all of them are.
    rows_per_y_ =
        std::min(static_cast<double>(count) / (high - low_), std::numeric_limits<double>::max());
    first_.assign(count + 1, 0);
    const auto for_each_row = [this](const DirectedSegment& s, auto visit) {
        const auto [bottom, top] = std::minmax({row(s.from.y), row(s.to.y)});
        for (std::size_t r = bottom; r <= top; ++r)
            visit(r);
    };
    for (const DirectedSegment& s : segments)
        for_each_row(s, [this](std::size_t r) { ++first_[r + 1]; });
    for (std::size_t r = 0; r < count; ++r)
        first_[r + 1] += first_[r];
    segments_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const DirectedSegment& s : segments)
        for_each_row(s, [&](std::size_t r) { segments_[next[r]++] = s; });
}

// Monotone in y, so that a segment is in the rows of all its positions, whatever rounding does.
std::size_t WindingNumber::row(double y) const {
    const double last = static_cast<double>(first_.size() - 2);
    return static_cast<std::size_t>(std::clamp((y - low_) * rows_per_y_, 0.0, last));
}

// Counts the segments that a ray towards +x crosses; each holds its lower end and not its upper.
int WindingNumber::around(Point2 p) const {
    int winding = 0;
    const std::size_t r = row(p.y);
    for (std::size_t i = first_[r]; i < first_[r + 1]; ++i) {
        const auto& [from, to] = segments_[i];
        const bool rises = from.y <= p.y && p.y < to.y;
        const bool falls = to.y <= p.y && p.y < from.y;
        if (rises && orientation(from, to, p) == Orientation::CounterClockwise) ++winding;
        if (falls && orientation(from, to, p) == Orientation::Clockwise) --winding;
    }
    return winding;
}

bool WindingNumber::is_clear(Point2 p, double distance) const {
    const std::size_t top = row(p.y + distance);
    for (std::size_t i = first_[row(p.y - distance)]; i < first_[top + 1]; ++i) {
        const auto& [from, to] = segments_[i];
        const auto [left, right] = std::minmax(from.x, to.x);
        if (p.x + distance < left || right < p.x - distance) continue;
        if (distance_to_segment(p, from, to) <= distance) return false;
    }
    return true;
}

}  // namespace tinsmith::core
