// SPDX-License-Identifier: Apache-2.0
#include "tests/verify/mesh_view.hpp"

#include <algorithm>
#include <cmath>

#include "tests/verify/exact.hpp"

namespace tinsmith::verify {

using core::MeshData;

Stars::Stars(const MeshData& mesh) : first_(mesh.vertices.size() + 1, 0) {
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t)
            ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v)
        first_[v] += first_[v - 1];
    corners_.resize(mesh.triangles.size() * 3);
    std::vector<std::size_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        corners_[at[a]++] = {b, c, t};
        corners_[at[b]++] = {c, a, t};
        corners_[at[c]++] = {a, b, t};
    }
    for (std::size_t v = 0; v + 1 < first_.size(); ++v)
        std::sort(corners_.begin() + static_cast<std::ptrdiff_t>(first_[v]),
                  corners_.begin() + static_cast<std::ptrdiff_t>(first_[v + 1]),
                  [](const Corner& l, const Corner& r) { return l.next < r.next; });
}

std::uint32_t Stars::triangle_of(std::uint32_t a, std::uint32_t b) const {
    const auto star = around(a);
    const auto found = std::lower_bound(
        star.begin(), star.end(), b, [](const Corner& l, std::uint32_t r) { return l.next < r; });
    return found != star.end() && found->next == b ? found->triangle : kNone;
}

TriangleGrid::TriangleGrid(const MeshData& mesh) : mesh_(&mesh) {
    min_ = max_ = mesh.vertices.front().plan();
    for (const Point3& v : mesh.vertices) {
        min_ = {std::min(min_.x, v.x), std::min(min_.y, v.y)};
        max_ = {std::max(max_.x, v.x), std::max(max_.y, v.y)};
    }
    double largest = 0.0;
    for (const double c : {min_.x, min_.y, max_.x, max_.y})
        largest = std::max(largest, std::fabs(c));
    reach_ = 4.0 * (std::nextafter(largest, HUGE_VAL) - largest);
    const double half = static_cast<double>(mesh.triangles.size()) / 2.0;
    columns_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(half)), 1, 2000);
    boxes_.resize(mesh.triangles.size());
    first_.assign(columns_ * columns_ + 1, 0);
    const auto cells = [this](const Box& box, const auto& visit) {
        for (std::size_t r = row(box.low.y); r <= row(box.high.y); ++r)
            for (std::size_t c = column(box.low.x); c <= column(box.high.x); ++c)
                visit(r * columns_ + c);
    };
    for (std::uint32_t t = 0; t < boxes_.size(); ++t) {
        const auto [a, b, c] = corners(t);
        boxes_[t] = {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                     {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
        cells(boxes_[t], [this](std::size_t cell) { ++first_[cell + 1]; });
    }
    for (std::size_t i = 1; i < first_.size(); ++i)
        first_[i] += first_[i - 1];
    entries_.resize(first_.back());
    std::vector<std::size_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < boxes_.size(); ++t)
        cells(boxes_[t], [&](std::size_t cell) { entries_[at[cell]++] = t; });
}

double TriangleGrid::extent() const {
    return std::hypot(max_.x - min_.x, max_.y - min_.y);
}

std::size_t TriangleGrid::cell_of(double offset, double width) const {
    const double cell = offset / width * static_cast<double>(columns_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(columns_ - 1)));
}

std::uint32_t TriangleGrid::triangle_at(Point2 p) const {
    std::uint32_t found = kNone;
    near(p, p, [&](std::uint32_t t) {
        if (found != kNone) return;
        const auto [a, b, c] = corners(t);
        if (side_of(a, b, p) >= 0 && side_of(b, c, p) >= 0 && side_of(c, a, p) >= 0) found = t;
    });
    return found;
}

bool TriangleGrid::holds(Point2 p, double reach) const {
    const double wide = std::max(reach, 0.0);
    bool found = false;
    near({p.x - wide, p.y - wide}, {p.x + wide, p.y + wide}, [&](std::uint32_t t) {
        if (found) return;
        const auto [a, b, c] = corners(t);
        const bool inside = side_of(a, b, p) >= 0 && side_of(b, c, p) >= 0 && side_of(c, a, p) >= 0;
        const double nearest =
            std::min({distance_to(p, a, b), distance_to(p, b, c), distance_to(p, c, a)});
        found = inside ? nearest >= -reach : nearest <= reach;
    });
    return found;
}

}  // namespace tinsmith::verify
