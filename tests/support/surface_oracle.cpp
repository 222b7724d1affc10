// SPDX-License-Identifier: Apache-2.0
#include "tests/support/surface_oracle.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/quad.hpp"

namespace tinsmith::test {

using core::Point2;
using core::Point3;

SurfaceOracle::SurfaceOracle(const core::MeshData& mesh) : mesh_(mesh) {
    min_ = max_ = mesh_.vertices.front().plan();
    for (const Point3& v : mesh_.vertices) {
        min_ = {std::min(min_.x, v.x), std::min(min_.y, v.y)};
        max_ = {std::max(max_.x, v.x), std::max(max_.y, v.y)};
    }
    columns_ = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::sqrt(static_cast<double>(mesh_.triangles.size()) / 2.0)), 1,
        2000);
    cells_.resize(columns_ * columns_);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const auto [a, b, c] = mesh_.triangles[t];
        const auto xs =
            std::minmax({mesh_.vertices[a].x, mesh_.vertices[b].x, mesh_.vertices[c].x});
        const auto ys =
            std::minmax({mesh_.vertices[a].y, mesh_.vertices[b].y, mesh_.vertices[c].y});
        for (std::size_t r = row(ys.first); r <= row(ys.second); ++r)
            for (std::size_t k = column(xs.first); k <= column(xs.second); ++k)
                cells_[r * columns_ + k].push_back(t);
    }
}

std::size_t SurfaceOracle::column(double x) const {
    const double cell = (x - min_.x) / (max_.x - min_.x) * static_cast<double>(columns_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t SurfaceOracle::row(double y) const {
    const double cell = (y - min_.y) / (max_.y - min_.y) * static_cast<double>(columns_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(columns_ - 1)));
}

std::optional<std::uint32_t> SurfaceOracle::triangle_at(Point2 p, double slack) const {
    std::optional<std::uint32_t> best;
    double best_inset = -slack;
    for (const std::uint32_t t : cells_[row(p.y) * columns_ + column(p.x)]) {
        double inset = HUGE_VAL;  // distance inside the nearest edge; negative outside
        for (unsigned i = 0; i < 3; ++i) {
            const Point2 a = mesh_.vertices[mesh_.triangles[t][i]].plan();
            const Point2 b = mesh_.vertices[mesh_.triangles[t][(i + 1) % 3]].plan();
            inset = std::min(inset,
                             static_cast<double>(area(a, b, p)) / std::hypot(b.x - a.x, b.y - a.y));
        }
        if (inset >= best_inset) {
            best = t;
            best_inset = inset;
        }
    }
    return best;
}

double SurfaceOracle::elevation(std::uint32_t t, Point2 p) const {
    const Point3& a = mesh_.vertices[mesh_.triangles[t][0]];
    const Point3& b = mesh_.vertices[mesh_.triangles[t][1]];
    const Point3& c = mesh_.vertices[mesh_.triangles[t][2]];
    const Quad wa = area(b.plan(), c.plan(), p);
    const Quad wb = area(c.plan(), a.plan(), p);
    const Quad wc = area(a.plan(), b.plan(), p);
    return static_cast<double>((wa * Quad(a.z) + wb * Quad(b.z) + wc * Quad(c.z)) / (wa + wb + wc));
}

double SurfaceOracle::slope(std::uint32_t t) const {
    const Point3& a = mesh_.vertices[mesh_.triangles[t][0]];
    const Point3& b = mesh_.vertices[mesh_.triangles[t][1]];
    const Point3& c = mesh_.vertices[mesh_.triangles[t][2]];
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    return std::hypot(uy * vz - uz * vy, uz * vx - ux * vz) /
           static_cast<double>(area(a.plan(), b.plan(), c.plan()));
}

}  // namespace tinsmith::test
