// SPDX-License-Identifier: Apache-2.0
// What a mesh made of a grid has beside its slots.
#include <algorithm>
#include <array>

#include "core/mesh/components.hpp"
#include "core/mesh/grid_builder.hpp"

namespace tinsmith::core {

/// Further fans get copies of their vertex, in the order of their lowest sides.
void GridBuilder::copy_vertices() {
    std::vector<Copy> copies;
    for (Band& band : bands_) {
        copies.insert(copies.end(), band.copies.begin(), band.copies.end());
        band.copies = {};
    }
    std::sort(copies.begin(), copies.end(),
              [](const Copy& a, const Copy& b) { return a.fan.lowest < b.fan.lowest; });
    for (const auto& [named, fan] : copies) {
        const VertexId copy{static_cast<std::uint32_t>(tin_.vertices_.size())};
        const Tin::Vertex original = tin_.vertex(named);
        tin_.vertices_.push_back({original.x, original.y, original.z, fan.triangle});
        rename(fan, copy);
    }
}

/// Gives the triangles of a fan another vertex. It ends on both sides: another one is beside it.
void GridBuilder::rename(const Fan& fan, VertexId copy) {
    const auto take = [&](Side s) {
        tin_.triangles_[s.triangle().index()].vertices[s.index()] = copy;
    };
    for (Side s = fan.lowest; s.valid(); s = tin_.twin(s.previous()))
        take(s);
    for (Side s = tin_.twin(fan.lowest); s.valid(); s = tin_.twin(s)) {
        s = s.next();
        take(s);
    }
}

void GridBuilder::index() {
    tin_.next_facet_ = static_cast<std::uint32_t>(tin_.triangles_.size());
    tin_.built_vertex_count_ = tin_.vertices_.size();
    bound();
    std::vector<Side> border;
    for (Band& band : bands_) {
        border.insert(border.end(), band.border.begin(), band.border.end());
        band.border = {};
    }
    tin_.boundary_ = tin_.index_boundary(border);
    tin_.components_ = is_whole() ? std::vector{TriangleId{0}} : find_components(tin_);
    hint();
}

/// Of zeros with either sign a bound is the one that comes first: posts are looked at in order, and
/// so are bands.
void GridBuilder::bound() {
    Band all;
    for (const Band& band : bands_)
        all.take(band);
    const auto [west, east] = std::minmax(x_[static_cast<std::size_t>(all.first_used.column)],
                                          x_[static_cast<std::size_t>(all.last_used.column)]);
    const auto [south, north] = std::minmax(y_[static_cast<std::size_t>(all.first_used.row)],
                                            y_[static_cast<std::size_t>(all.last_used.row)]);
    tin_.bounds_ = {{west, south, all.low}, {east, north, all.high}};
}

/// A triangle's centroid is in a row of hints by the cell's row and in a column by the cell's
/// column, for each of the four triangles that a cell may have. Jobs have rows of hints each.
void GridBuilder::hint() {
    tin_.lay_out_hints();
    const auto places = [](std::ptrdiff_t count, auto place_of) {
        std::vector<HintPlaces> found(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < found.size(); ++i)
            for (unsigned without = 0; without < 4; ++without)
                found[i][without] =
                    static_cast<std::uint32_t>(place_of(i, kTriangleWithout[without]));
        return found;
    };
    hint_columns_ = places(columns_, [this](std::size_t c, const auto& corners) {
        std::array<double, 3> x{};
        for (unsigned i = 0; i < 3; ++i)
            x[i] = x_[c + static_cast<std::size_t>(compass_.post({}, corners[i]).column)];
        return tin_.hint_column((x[0] + x[1] + x[2]) / 3.0);
    });
    hint_rows_ = places(rows_, [this](std::size_t r, const auto& corners) {
        std::array<double, 3> y{};
        for (unsigned i = 0; i < 3; ++i)
            y[i] = y_[r + static_cast<std::size_t>(compass_.post({}, corners[i]).row)];
        return tin_.hint_row((y[0] + y[1] + y[2]) / 3.0) * tin_.hint_columns_;
    });
    std::vector<Job> jobs;
    const std::size_t count = bands_.size(), rows = tin_.hint_columns_;
    for (std::size_t i = 0; i < count; ++i) {
        jobs.emplace_back([this, i, count, rows] {
            hint(rows * i / count * tin_.hint_columns_,
                 rows * (i + 1) / count * tin_.hint_columns_);
        });
    }
    execute_(jobs);
    tin_.fill_hints();
}

/// The hints from one place to another, beginnings of rows: the last triangle that falls into one
/// is the one that stays.
void GridBuilder::hint(std::size_t begin, std::size_t end) {
    for (std::ptrdiff_t row = 0; row < rows_; ++row) {
        const HintPlaces& rows = hint_rows_[static_cast<std::size_t>(row)];
        std::array<bool, 4> is_here{};
        for (unsigned without = 0; without < 4; ++without)
            is_here[without] = rows[without] >= begin && rows[without] < end;
        if (std::find(is_here.begin(), is_here.end(), true) == is_here.end()) continue;
        const CellCut* const cuts = cuts_.row(row);
        std::uint32_t slot = first_slot({row, 0});
        for (std::ptrdiff_t c = 0; c < columns_; ++c) {
            const HintPlaces& columns = hint_columns_[static_cast<std::size_t>(c)];
            const CutTriangles& triangles = triangles_of(cuts[c]);
            for (unsigned local = 0; local < triangles.count; ++local, ++slot) {
                const unsigned without = triangles.without[local];
                if (is_here[without]) tin_.hints_[rows[without] + columns[without]] = {slot};
            }
        }
    }
}

}  // namespace tinsmith::core
