// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/box_grid.hpp"

#include <algorithm>
#include <cmath>

namespace tinsmith::core {

Box Box::around(Point2 p, Point2 q, double slack) {
    return {{std::min(p.x, q.x) - slack, std::min(p.y, q.y) - slack},
            {std::max(p.x, q.x) + slack, std::max(p.y, q.y) + slack}};
}

void Box::include(const Box& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y)};
}

BoxGrid::BoxGrid(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
    if (boxes_.empty()) {
        first_.assign(2, 0);
        return;
    }
    all_ = boxes_.front();
    for (const Box& box : boxes_)
        all_.include(box);
    columns_ = static_cast<std::size_t>(
        std::clamp(std::sqrt(static_cast<double>(boxes_.size()) / 2.0), 1.0, 1024.0));
    const auto per_unit = [this](double width) {
        const double cells = static_cast<double>(columns_) / width;
        return width > 0.0 && std::isfinite(cells) ? cells : 0.0;
    };
    per_x_ = per_unit(all_.high.x - all_.low.x);
    per_y_ = per_unit(all_.high.y - all_.low.y);
    // Counted first, then filed.
    first_.assign(columns_ * columns_ + 1, 0);
    const auto each_cell = [this](const Box& box, const auto& visit) {
        const Cells cells = cells_of(box);
        for (std::size_t row = cells.low; row <= cells.high; ++row)
            for (std::size_t column = cells.left; column <= cells.right; ++column)
                visit(row * columns_ + column);
    };
    for (const Box& box : boxes_)
        each_cell(box, [this](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i)
        first_[i] += first_[i - 1];
    entries_.resize(first_.back());
    std::vector<std::size_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
        each_cell(boxes_[i], [&](std::size_t cell) { entries_[at[cell]++] = i; });
}

/// Where boxes reach to infinity, or all are in one place, offsets times cells are no numbers: all
/// such places are in the first cell, boxes and questions alike.
std::size_t BoxGrid::cell_of(double offset, double per_unit) const {
    const double cell = offset * per_unit;
    return cell > 0.0 ? static_cast<std::size_t>(std::min(cell, static_cast<double>(columns_ - 1)))
                      : 0;
}

BoxGrid::Cells BoxGrid::cells_of(const Box& box) const {
    return {cell_of(box.low.x - all_.low.x, per_x_), cell_of(box.high.x - all_.low.x, per_x_),
            cell_of(box.low.y - all_.low.y, per_y_), cell_of(box.high.y - all_.low.y, per_y_)};
}

const std::vector<std::uint32_t>& BoxGrid::near(const Box& box) {
    found_.clear();
    if (boxes_.empty()) return found_;
    const Cells cells = cells_of(box);
    for (std::size_t row = cells.low; row <= cells.high; ++row) {
        for (std::size_t column = cells.left; column <= cells.right; ++column) {
            const std::size_t cell = row * columns_ + column;
            for (std::size_t i = first_[cell]; i < first_[cell + 1]; ++i)
                if (boxes_[entries_[i]].meets(box)) found_.push_back(entries_[i]);
        }
    }
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return found_;
}

}  // namespace tinsmith::core
