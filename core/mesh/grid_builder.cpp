// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/grid_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

/// Enough for any machine's processors.
constexpr std::ptrdiff_t kMostBands = 16;

std::ptrdiff_t cells_between(std::size_t posts) {
    return posts > 0 ? static_cast<std::ptrdiff_t>(posts - 1) : 0;
}

/// The posts' coordinates along one axis; none where they are not apart or not in range.
template <typename At>
std::vector<double> positions(std::size_t count, double step, At at) {
    std::vector<double> found;
    found.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double here = at(i);
        if (!in_coordinate_range(here)) return {};
        const bool is_apart = i == 0 || (step > 0.0 ? here > found.back() : here < found.back());
        if (!is_apart) return {};
        found.push_back(here);
    }
    return found;
}

/// Whether all are such as the core takes, or NaN. Nearly always they are no zeros either, which
/// one comparison of their bits tells.
bool are_sound(std::span<const double> elevations) {
    constexpr auto low = std::bit_cast<std::uint64_t>(kCoordinateFloor);
    constexpr auto high = std::bit_cast<std::uint64_t>(kCoordinateLimit);
    bool are_plain = true;
    for (const double z : elevations)
        are_plain &= (std::bit_cast<std::uint64_t>(z) << 1 >> 1) - low <= high - low;
    return are_plain || std::all_of(elevations.begin(), elevations.end(), [](double z) {
               return std::isnan(z) || in_coordinate_range(z);
           });
}

}  // namespace

GridBuilder::GridBuilder(const PostGrid& grid, std::size_t most_triangles, const Executor& execute,
                         std::ptrdiff_t cells_of_band)
    : grid_(grid),
      most_triangles_(std::min(most_triangles, kMaxTriangles)),
      execute_(execute),
      cells_of_band_(cells_of_band),
      compass_(grid.dx > 0.0, grid.dy > 0.0),
      rows_(cells_between(grid.rows)),
      columns_(cells_between(grid.columns)),
      x_(positions(grid.columns, grid.dx, [&](std::size_t i) { return grid.x(i); })),
      y_(positions(grid.rows, grid.dy, [&](std::size_t i) { return grid.y(i); })),
      cuts_(rows_, columns_) {
    for (unsigned falling = 0; falling < 16; ++falling) {
        std::array<CellAround, 4> around;
        for (unsigned corner = 0; corner < 4; ++corner) {
            const GridPlace cell = compass_.cell_at({1, 1}, corner);
            const auto at = static_cast<unsigned>(2 * cell.row + cell.column);
            around[corner] = {(falling >> at & 1U) != 0 ? CellCut::Falling : CellCut::Rising,
                              2 * at};
        }
        inner_fans_[falling] =
            static_cast<std::uint8_t>(fans_around(around).fans[0].triangle.value);
    }
}

std::optional<Tin> GridBuilder::build() {
    if (x_.empty() || y_.empty()) return std::nullopt;
    part();
    for_each_band(&GridBuilder::cut);
    std::size_t triangles = 0;
    for (const Band& band : bands_) {
        if (!band.is_sound) return std::nullopt;
        triangles += band.triangles;
    }
    if (triangles == 0 || triangles > most_triangles_) return std::nullopt;
    std::size_t vertices = grid_.elevations.size();
    if (triangles < 2 * static_cast<std::size_t>(rows_ * columns_)) vertices = number_slots();

    tin_.reserve_growth(vertices, triangles);
    tin_.vertices_.resize(vertices);
    tin_.triangles_.resize(triangles);
    for_each_band(&GridBuilder::write);
    copy_vertices();
    index();
    return std::move(tin_);
}

void GridBuilder::part() {
    const std::ptrdiff_t count = std::clamp(rows_ * columns_ / cells_of_band_, std::ptrdiff_t{1},
                                            std::min(kMostBands, rows_));
    bands_.resize(static_cast<std::size_t>(count));
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        Band& band = bands_[static_cast<std::size_t>(i)];
        band.begin = rows_ * i / count;
        band.end = rows_ * (i + 1) / count;
        band.end_of_posts = band.end + (i + 1 == count ? 1 : 0);
    }
}

void GridBuilder::for_each_band(void (GridBuilder::*pass)(Band&)) {
    std::vector<Job> jobs;
    for (Band& band : bands_)
        jobs.emplace_back([this, pass, &band] { (this->*pass)(band); });
    execute_(jobs);
}

void GridBuilder::cut(Band& band) {
    const double* const elevations = grid_.elevations.data();
    const std::ptrdiff_t posts = columns_ + 1;
    for (std::ptrdiff_t row = band.begin; row < band.end_of_posts; ++row)
        band.is_sound &= are_sound({elevations + row * posts, grid_.columns});
    std::array<std::ptrdiff_t, 4> corner{};
    for (unsigned i = 0; i < 4; ++i) {
        const GridPlace post = compass_.post({}, i);
        corner[i] = post.row * posts + post.column;
    }
    std::size_t triangles = 0;
    for (std::ptrdiff_t row = band.begin; row < band.end; ++row) {
        const double* const first = elevations + row * posts;
        CellCut* const cuts = cuts_.row(row);
        for (std::ptrdiff_t c = 0; c < columns_; ++c) {
            const double* const at = first + c;
            const CellCut cut = cut_of(at[corner[0]], at[corner[1]], at[corner[2]], at[corner[3]]);
            cuts[c] = cut;
            triangles += cut >= CellCut::Rising ? 2 : cut != CellCut::None ? 1 : 0;
        }
    }
    band.triangles = triangles;
}

/// Where posts are missing, triangles and vertices are counted from the first on. Gives how many
/// vertices there are.
std::size_t GridBuilder::number_slots() {
    slots_.resize(static_cast<std::size_t>(rows_ * columns_));
    std::uint32_t triangles = 0;
    auto slot = slots_.begin();
    for (std::ptrdiff_t row = 0; row < rows_; ++row) {
        for (std::ptrdiff_t c = 0; c < columns_; ++c) {
            *slot++ = triangles;
            triangles += triangles_of(cuts_.row(row)[c]).count;
        }
    }
    vertices_.resize(grid_.elevations.size());
    std::uint32_t vertices = 0;
    auto vertex = vertices_.begin();
    for (std::ptrdiff_t row = 0; row <= rows_; ++row) {
        for (std::ptrdiff_t c = 0; c <= columns_; ++c) {
            bool is_used = false;
            for (unsigned corner = 0; corner < 4; ++corner)
                is_used |= has_corner(cuts_[compass_.cell_at({row, c}, corner)], corner);
            *vertex++ = vertices;
            vertices += is_used ? 1 : 0;
        }
    }
    return vertices;
}

std::optional<Tin> build_tin_of_grid(const PostGrid& grid, std::size_t most_triangles,
                                     const Executor& execute) {
    const std::size_t posts = grid.elevations.size();
    if (grid.columns < 2 || grid.rows < 2 || posts > kMaxVertices) return std::nullopt;
    if (posts / grid.columns != grid.rows || posts % grid.columns != 0) return std::nullopt;
    return GridBuilder(grid, most_triangles, execute).build();
}

}  // namespace tinsmith::core
