// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/terrains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace tinsmith::bench {

namespace {

/// In [-1, 1), from the engine's bits alone: the standard's distributions differ between libraries.
double signed_unit(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
}

/// Elevations on a square grid; NaN where there is no post.
class Raster {
  public:
    Raster(double x, double y, double spacing, std::size_t columns, std::size_t rows)
        : x_(x), y_(y), spacing_(spacing), columns_(columns), rows_(rows) {
        posts_.assign(columns * rows, std::numeric_limits<double>::quiet_NaN());
    }

    static Raster of_grid(const core::MeshData& grid) {
        std::vector<double> xs, ys;
        for (const core::Point3& v : grid.vertices) {
            xs.push_back(v.x);
            ys.push_back(v.y);
        }
        std::ranges::sort(xs);
        const double spacing = *std::ranges::upper_bound(xs, xs.front()) - xs.front();
        const auto [low, high] = std::ranges::minmax(ys);
        const auto count = [spacing](double extent) {
            return static_cast<std::size_t>(std::lround(extent / spacing)) + 1;
        };
        Raster raster(xs.front(), low, spacing, count(xs.back() - xs.front()), count(high - low));
        for (const core::Point3& v : grid.vertices)
            raster.at(count(v.x - raster.x_) - 1, count(v.y - raster.y_) - 1) = v.z;
        return raster;
    }

    double& at(std::size_t column, std::size_t row) { return posts_[row * columns_ + column]; }
    double at(std::size_t column, std::size_t row) const { return posts_[row * columns_ + column]; }

    /// Bilinear; NaN where one of the four posts around is missing.
    double elevation(double x, double y) const {
        const double u = (x - x_) / spacing_, v = (y - y_) / spacing_;
        const auto c = std::min(static_cast<std::size_t>(u), columns_ - 2);
        const auto r = std::min(static_cast<std::size_t>(v), rows_ - 2);
        const double s = u - static_cast<double>(c), t = v - static_cast<double>(r);
        return (at(c, r) * (1 - s) + at(c + 1, r) * s) * (1 - t) +
               (at(c, r + 1) * (1 - s) + at(c + 1, r + 1) * s) * t;
    }

    Raster finer(double factor, double noise) const {
        const auto count = [factor](std::size_t posts) {
            return static_cast<std::size_t>(static_cast<double>(posts - 1) * factor) + 1;
        };
        Raster made(x_, y_, spacing_ / factor, count(columns_), count(rows_));
        std::mt19937_64 random(1);
        for (std::size_t r = 0; r < made.rows_; ++r)
            for (std::size_t c = 0; c < made.columns_; ++c)
                made.at(c, r) = elevation(made.x(c), made.y(r)) + noise * signed_unit(random);
        return made;
    }

    /// Two triangles a cell with four posts.
    core::MeshData mesh() const {
        core::MeshData mesh;
        std::vector<std::uint32_t> slots(posts_.size(), UINT32_MAX);
        const auto post = [&](std::size_t c, std::size_t r) {
            std::uint32_t& slot = slots[r * columns_ + c];
            if (slot == UINT32_MAX) {
                slot = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back({x(c), y(r), at(c, r)});
            }
            return slot;
        };
        for (std::size_t r = 0; r + 1 < rows_; ++r) {
            for (std::size_t c = 0; c + 1 < columns_; ++c) {
                if (std::isnan(at(c, r) + at(c + 1, r) + at(c, r + 1) + at(c + 1, r + 1))) continue;
                const std::uint32_t low = post(c, r), right = post(c + 1, r);
                const std::uint32_t far = post(c + 1, r + 1), left = post(c, r + 1);
                mesh.triangles.push_back({low, right, far});
                mesh.triangles.push_back({low, far, left});
            }
        }
        return mesh;
    }

  private:
    double x(std::size_t column) const { return x_ + spacing_ * static_cast<double>(column); }
    double y(std::size_t row) const { return y_ + spacing_ * static_cast<double>(row); }

    double x_, y_, spacing_;
    std::size_t columns_, rows_;
    std::vector<double> posts_;  ///< row by row
};

/// Displaces the middles of ever shorter stretches of a closed line of `count` values.
std::vector<double> midpoint_displacement(std::size_t count) {
    constexpr double kRoughness = 0.75;
    std::vector<double> values(count + 1, 0.0);
    std::mt19937_64 random(2);
    std::vector<std::pair<std::size_t, std::size_t>> pending{{0, count}};
    for (std::size_t i = 0; i < pending.size(); ++i) {  // breadth first
        const auto [first, last] = pending[i];
        if (last - first < 2) continue;
        const std::size_t middle = (first + last) / 2;
        const double length = static_cast<double>(last - first) / static_cast<double>(count);
        values[middle] =
            (values[first] + values[last]) / 2 + std::pow(length, kRoughness) * signed_unit(random);
        pending.emplace_back(first, middle);
        pending.emplace_back(middle, last);
    }
    values.pop_back();
    return values;
}

}  // namespace

core::MeshData resampled(const core::MeshData& grid, std::size_t triangles, double noise) {
    const double factor =
        std::sqrt(static_cast<double>(triangles) / static_cast<double>(grid.triangles.size()));
    return Raster::of_grid(grid).finer(factor, noise).mesh();
}

core::Shape shoreline(const core::Bounds& bounds, double share, std::size_t segments) {
    const std::vector<double> bays = midpoint_displacement(segments);
    const auto [deepest, shallowest] = std::ranges::minmax(bays);
    const double half_width = share / 2 * (bounds.max.x - bounds.min.x);
    const double half_height = share / 2 * (bounds.max.y - bounds.min.y);
    core::Path ring;
    ring.closed = true;
    for (std::size_t i = 0; i < segments; ++i) {
        const double turn =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(segments);
        const double c = std::cos(turn), s = std::sin(turn);
        const double rounded = std::pow(c * c * c * c + s * s * s * s, -0.25);
        const double radius = rounded * (0.6 + 0.4 * (bays[i] - deepest) / (shallowest - deepest));
        ring.points.push_back({(bounds.min.x + bounds.max.x) / 2 + half_width * radius * c,
                               (bounds.min.y + bounds.max.y) / 2 + half_height * radius * s});
    }
    return {{ring}};
}

}  // namespace tinsmith::bench
