// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/boundary_index.hpp"

#include <algorithm>
#include <cmath>

namespace tinsmith::core {

BoundaryIndex::BoundaryIndex(Point2 min, Point2 max, std::size_t edges) : min_(min), max_(max) {
    make_grid(edges);
}

/// An empty grid for so many edges.
void BoundaryIndex::make_grid(std::size_t edges) {
    const double width = max_.x - min_.x;
    const double height = max_.y - min_.y;
    const double side = std::clamp(std::sqrt(static_cast<double>(edges)), 1.0, 2048.0);
    columns_ = rows_ = static_cast<std::size_t>(side);
    cells_per_x_ = width > 0.0 ? static_cast<double>(columns_) / width : 0.0;
    cells_per_y_ = height > 0.0 ? static_cast<double>(rows_) / height : 0.0;
    cells_.assign(columns_ * rows_, {});
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

BoundaryIndex::CellRange BoundaryIndex::cells_of(const Entry& entry) const {
    const auto [left, right] = std::minmax({column(entry.p.x), column(entry.q.x)});
    const auto [low, high] = std::minmax({row(entry.p.y), row(entry.q.y)});
    return {left, right, low, high};
}

void BoundaryIndex::file(std::uint32_t entry) {
    const CellRange range = cells_of(entries_[entry]);
    for (std::size_t r = range.low; r <= range.high; ++r)
        for (std::size_t c = range.left; c <= range.right; ++c)
            cells_[r * columns_ + c].push_back(entry);
}

void BoundaryIndex::append(const Entry& entry) {
    entries_.push_back(entry);
    constexpr std::size_t kCrowded = 8;
    if (entries_.size() <= kCrowded * cells_.size() || columns_ >= 2048) {
        file(static_cast<std::uint32_t>(entries_.size() - 1));
        return;
    }
    make_grid(2 * entries_.size());
    for (std::uint32_t i = 0; i < entries_.size(); ++i)
        file(i);
}

void BoundaryIndex::add(VertexId v, Point2 p, Point2 q) {
    append({v, p, q});
    changes_.push_back({});
}

/// The newest entry under v of an edge through p; all ones where there is none.
std::uint32_t BoundaryIndex::find(VertexId v, Point2 p) const {
    const auto& cell = cells_[row(p.y) * columns_ + column(p.x)];
    const auto found = std::find_if(cell.rbegin(), cell.rend(),
                                    [&](std::uint32_t i) { return entries_[i].vertex == v; });
    return found == cell.rend() ? UINT32_MAX : *found;
}

void BoundaryIndex::add_split(VertexId v, Point2 a, VertexId w, Point2 p, Point2 b) {
    const auto length = [](Point2 from, Point2 to) {
        return std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    };
    const std::uint32_t known = find(v, p);
    if (known == UINT32_MAX) {  // rounding put p outside the cells of a-b
        add(v, a, p);
        add(w, p, b);
        return;
    }
    if (length(p, b) <= length(a, p)) {
        add(w, p, b);
        return;
    }
    entries_[known].vertex = w;
    append({v, a, p});
    changes_.push_back({known, v});
}

void BoundaryIndex::take_back(std::size_t count) {
    while (changes_.size() > count) {
        const Change change = changes_.back();
        changes_.pop_back();
        const CellRange range = cells_of(entries_.back());
        for (std::size_t r = range.low; r <= range.high; ++r)
            for (std::size_t c = range.left; c <= range.right; ++c)
                cells_[r * columns_ + c].pop_back();
        entries_.pop_back();
        if (change.renamed != UINT32_MAX) entries_[change.renamed].vertex = change.before;
    }
}

std::size_t BoundaryIndex::memory_bytes() const {
    std::size_t bytes = entries_.size() * sizeof(Entry) + changes_.size() * sizeof(Change) +
                        cells_.size() * sizeof(cells_[0]);
    for (const auto& cell : cells_)
        bytes += cell.size() * sizeof(std::uint32_t);
    return bytes;
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
            for (const std::uint32_t entry : cell)
                found.push_back(entries_[entry].vertex);
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace tinsmith::core
