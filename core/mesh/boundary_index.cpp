// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/boundary_index.hpp"

#include <algorithm>
#include <cmath>

namespace tinsmith::core {

BoundaryIndex::BoundaryIndex(Point2 min, Point2 max, std::size_t edges) : min_(min), max_(max) {
    const double width = max.x - min.x;
    const double height = max.y - min.y;
    const double side = std::clamp(std::sqrt(static_cast<double>(edges)), 1.0, 2048.0);
    columns_ = rows_ = static_cast<std::size_t>(side);
    cells_per_x_ = width > 0.0 ? static_cast<double>(columns_) / width : 0.0;
    cells_per_y_ = height > 0.0 ? static_cast<double>(rows_) / height : 0.0;
    cells_.resize(columns_ * rows_);
}

// Monotone in the coordinate, so that a box covers all cells of the points in it, whatever
// rounding does. What lies outside the box counts to the nearest cell.
std::size_t BoundaryIndex::column(double x) const {
    const double cell = (x - min_.x) * cells_per_x_;
    return cell <= 0.0 ? 0
                       : std::min(columns_ - 1, static_cast<std::size_t>(std::min(cell, 4096.0)));
}

std::size_t BoundaryIndex::row(double y) const {
    const double cell = (y - min_.y) * cells_per_y_;
    return cell <= 0.0 ? 0 : std::min(rows_ - 1, static_cast<std::size_t>(std::min(cell, 4096.0)));
}

void BoundaryIndex::add(VertexId v, Point2 p, Point2 q, std::vector<std::size_t>* log) {
    const auto [left, right] = std::minmax({column(p.x), column(q.x)});
    const auto [low, high] = std::minmax({row(p.y), row(q.y)});
    for (std::size_t r = low; r <= high; ++r) {
        for (std::size_t c = left; c <= right; ++c) {
            const std::size_t cell = r * columns_ + c;
            if (std::find(cells_[cell].begin(), cells_[cell].end(), v) != cells_[cell].end())
                continue;
            cells_[cell].push_back(v);
            if (log != nullptr) log->push_back(cell);
        }
    }
}

void BoundaryIndex::remove_newest(const std::vector<std::size_t>& cells) {
    for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell)
        cells_[*cell].pop_back();
}

std::vector<VertexId> BoundaryIndex::near(Point2 p, Point2 q) const {
    std::vector<VertexId> found;
    if (cells_.empty()) return found;
    if (p.y > q.y) std::swap(p, q);
    // Row by row: only the columns that the segment can reach within the row, one more on either
    // side for rounding.
    const std::size_t low = row(p.y);
    const std::size_t high = row(q.y);
    const double run = q.y > p.y ? (q.x - p.x) / (q.y - p.y) : 0.0;
    for (std::size_t r = low; r <= high; ++r) {
        double x0 = p.x;
        double x1 = q.x;
        if (low != high) {
            const double bottom = min_.y + static_cast<double>(r) / cells_per_y_;
            const double top = min_.y + static_cast<double>(r + 1) / cells_per_y_;
            if (r != low) x0 = p.x + (bottom - p.y) * run;
            if (r != high) x1 = p.x + (top - p.y) * run;
        }
        const auto [left, right] = std::minmax({column(x0), column(x1)});
        const std::size_t last = std::min(right + 1, columns_ - 1);
        for (std::size_t c = left > 0 ? left - 1 : 0; c <= last; ++c) {
            const auto& cell = cells_[r * columns_ + c];
            found.insert(found.end(), cell.begin(), cell.end());
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace tinsmith::core
