// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/box_grid.hpp"

#include <algorithm>
#include <cmath>

namespace tinsmith::cgal {

Box Box::around(core::Point2 a, core::Point2 b, double margin) {
    return {{std::min(a.x, b.x) - margin, std::min(a.y, b.y) - margin},
            {std::max(a.x, b.x) + margin, std::max(a.y, b.y) + margin}};
}

BoxGrid::BoxGrid(const std::vector<Box>& boxes) : bounds_(boxes.front()) {
    for (const Box& box : boxes) {
        bounds_.low = {std::min(bounds_.low.x, box.low.x), std::min(bounds_.low.y, box.low.y)};
        bounds_.high = {std::max(bounds_.high.x, box.high.x), std::max(bounds_.high.y, box.high.y)};
    }
    columns_ = 1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(boxes.size()) / 2.0));
    cells_.resize(columns_ * columns_);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const Box& box = boxes[i];
        for (std::size_t r = cell(box.low.y, bounds_.low.y, bounds_.high.y);
             r <= cell(box.high.y, bounds_.low.y, bounds_.high.y); ++r)
            for (std::size_t c = cell(box.low.x, bounds_.low.x, bounds_.high.x);
                 c <= cell(box.high.x, bounds_.low.x, bounds_.high.x); ++c)
                cells_[r * columns_ + c].push_back(i);
    }
}

std::vector<std::uint32_t> BoxGrid::near(const Box& box) const {
    std::vector<std::uint32_t> found;
    for (std::size_t r = cell(box.low.y, bounds_.low.y, bounds_.high.y);
         r <= cell(box.high.y, bounds_.low.y, bounds_.high.y); ++r) {
        for (std::size_t c = cell(box.low.x, bounds_.low.x, bounds_.high.x);
             c <= cell(box.high.x, bounds_.low.x, bounds_.high.x); ++c) {
            const auto& here = cells_[r * columns_ + c];
            found.insert(found.end(), here.begin(), here.end());
        }
    }
    std::ranges::sort(found);
    found.erase(std::ranges::unique(found).begin(), found.end());
    return found;
}

std::size_t BoxGrid::cell(double value, double low, double high) const {
    const double share = (value - low) / (high - low) * static_cast<double>(columns_);
    return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(columns_ - 1)));
}

}  // namespace tinsmith::cgal
