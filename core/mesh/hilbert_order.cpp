// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/hilbert_order.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace tinsmith::core {

namespace {

constexpr unsigned kBits = 16;  ///< of a cell's column and row
constexpr double kCells = 65536.0;

/// How the curve goes through a square: through which quadrants, and turned how in each.
///
///     column, row of a quadrant:   01 11
///                                  00 10
struct Frame {
    std::array<std::uint8_t, 4> place;  ///< by quadrant 2 * column + row: the when of it
    std::array<std::uint8_t, 4> next;   ///< by quadrant: the turn within it
};
constexpr std::array<Frame, 4> kTurns = {{
    {{0, 1, 3, 2}, {1, 0, 3, 0}},  // up, right, down
    {{0, 3, 1, 2}, {0, 2, 1, 1}},  // right, up, left
    {{2, 3, 1, 0}, {2, 1, 2, 3}},  // from the upper right corner: left ...
    {{2, 1, 3, 0}, {3, 3, 0, 2}},
}};

/// Four levels of the curve at once.
struct FourLevels {
    std::uint8_t place;
    std::uint8_t next;
};

constexpr std::array<FourLevels, 4 * 256> four_levels() {
    std::array<FourLevels, 4 * 256> table{};
    for (unsigned turn = 0; turn < 4; ++turn) {
        for (unsigned cell = 0; cell < 256; ++cell) {
            unsigned place = 0, at = turn;
            for (unsigned level = 4; level-- > 0;) {
                const unsigned quadrant = 2 * ((cell >> (4 + level)) & 1U) + ((cell >> level) & 1U);
                place = 4 * place + kTurns[at].place[quadrant];
                at = kTurns[at].next[quadrant];
            }
            table[256 * turn + cell] = {static_cast<std::uint8_t>(place),
                                        static_cast<std::uint8_t>(at)};
        }
    }
    return table;
}
constexpr std::array<FourLevels, 4 * 256> kFourLevels = four_levels();

std::uint32_t place_of(std::uint32_t column, std::uint32_t row) {
    std::uint32_t place = 0;
    unsigned turn = 0;
    for (unsigned shift = kBits; shift > 0;) {
        shift -= 4;
        const unsigned cell = ((column >> shift & 15U) << 4) | (row >> shift & 15U);
        const FourLevels& levels = kFourLevels[256 * turn + cell];
        place = place << 8 | levels.place;
        turn = levels.next;
    }
    return place;
}

/// A place on the curve above a point's index: sorted as one number.
using Key = std::uint64_t;
constexpr std::uint32_t index_of(Key key) {
    return static_cast<std::uint32_t>(key);
}
constexpr std::uint32_t place_of(Key key) {
    return static_cast<std::uint32_t>(key >> 32);
}

class Sorter {
  public:
    Sorter(std::span<const Point3> points, std::vector<Key> indices)
        : points_(points), keys_(std::move(indices)) {}

    std::vector<std::uint32_t> order() {
        pending_.emplace_back(0, keys_.size());
        // A part is split, or its box shrinks to a cell of it: there is an end, after 20 scales at
        // most, for between them lies the whole range of coordinates.
        while (!pending_.empty()) {
            const auto [begin, end] = pending_.back();
            pending_.pop_back();
            sort_part(begin, end);
        }
        std::vector<std::uint32_t> order(keys_.size());
        for (std::size_t i = 0; i < order.size(); ++i)
            order[i] = index_of(keys_[i]);
        return order;
    }

  private:
    static constexpr std::size_t kFew = 32;
    static constexpr std::size_t kRadixFrom = 4096;

    const Point3& point(Key key) const { return points_[index_of(key)]; }

    void sort_part(std::size_t begin, std::size_t end) {
        if (!give_places(begin, end)) return;
        const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(begin);
        if (end - begin < kRadixFrom)
            std::sort(first, first + static_cast<std::ptrdiff_t>(end - begin));
        else
            sort_by_digits(begin, end);
        for (std::size_t i = begin; i < end;) {
            std::size_t next = i + 1;
            while (next < end && place_of(keys_[next]) == place_of(keys_[i]))
                ++next;
            if (next - i > kFew)
                pending_.emplace_back(i, next);
            else if (next - i > 1)
                sort_few(i, next);
            i = next;
        }
    }

    /// False where all points of the part are in one position: then they stand by index already.
    bool give_places(std::size_t begin, std::size_t end) {
        if (end - begin < 2) return false;
        Point2 low = point(keys_[begin]).plan(), high = low;
        for (std::size_t i = begin; i < end; ++i) {
            const Point3& p = point(keys_[i]);
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        const double extent = std::max(high.x - low.x, high.y - low.y);
        if (!(extent > 0.0)) return false;
        const double cells_per_unit = kCells / extent;
        const auto cell = [cells_per_unit](double from_edge) {
            return static_cast<std::uint32_t>(std::min(from_edge * cells_per_unit, kCells - 1.0));
        };
        for (std::size_t i = begin; i < end; ++i) {
            const Point3& p = point(keys_[i]);
            const Key place = place_of(cell(p.x - low.x), cell(p.y - low.y));
            keys_[i] = place << 32 | index_of(keys_[i]);
        }
        return true;
    }

    /// By three digits of the place, from the lowest: what is equal keeps its order, by index.
    void sort_by_digits(std::size_t begin, std::size_t end) {
        constexpr unsigned kDigit = 11;
        constexpr std::size_t kValues = std::size_t{1} << kDigit;
        spare_.resize(keys_.size());
        Key* from = keys_.data() + begin;
        Key* to = spare_.data() + begin;
        const std::size_t count = end - begin;
        std::array<std::array<std::uint32_t, kValues>, 3> starts{};
        for (std::size_t i = 0; i < count; ++i)
            for (unsigned digit = 0; digit < 3; ++digit)
                ++starts[digit][from[i] >> (32 + kDigit * digit) & (kValues - 1)];
        for (auto& start : starts) {
            std::uint32_t sum = 0;
            for (std::uint32_t& value : start)
                sum += std::exchange(value, sum);
        }
        for (unsigned digit = 0; digit < 3; ++digit) {
            for (std::size_t i = 0; i < count; ++i)
                to[starts[digit][from[i] >> (32 + kDigit * digit) & (kValues - 1)]++] = from[i];
            std::swap(from, to);
        }
        std::copy(from, from + count, to);  // an odd number of rounds: the result is in the spare
    }

    void sort_few(std::size_t begin, std::size_t end) {
        const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(begin);
        std::sort(first, first + static_cast<std::ptrdiff_t>(end - begin), [this](Key l, Key r) {
            const Point3 &p = point(l), &q = point(r);
            if (p.x != q.x) return p.x < q.x;
            if (p.y != q.y) return p.y < q.y;
            return index_of(l) < index_of(r);
        });
    }

    std::span<const Point3> points_;
    std::vector<Key> keys_;
    std::vector<Key> spare_;
    std::vector<std::pair<std::size_t, std::size_t>> pending_;
};

}  // namespace

std::vector<std::uint32_t> hilbert_order(std::span<const Point3> points,
                                         std::span<const std::uint32_t> those) {
    return Sorter(points, {those.begin(), those.end()}).order();
}

std::vector<std::uint32_t> hilbert_order(std::span<const Point3> points) {
    std::vector<Key> all(points.size());
    std::iota(all.begin(), all.end(), Key{0});
    return Sorter(points, std::move(all)).order();
}

}  // namespace tinsmith::core
