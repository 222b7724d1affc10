// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "api/formats/quantization.hpp"

namespace tinsmith::api {
namespace {

using Items = std::vector<std::uint32_t>;
using IntBox = Box<std::int32_t>;

bool wider_than(const IntBox& box, std::int64_t width) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::int64_t{box.high[axis]} - box.low[axis] > width) return true;
    }
    return false;
}

/// Cuts the items into runs no wider than `span` on this axis and appends them to `runs`.
///
///   the lowest low left                 lowest + span
///        |=====================================|
///          [--]  [-----] taken          [---]     [----] left for the next run
///                                           [------]     left: reaches over
/// Items keep their order, so rising indices stay rising.
void cut_axis(std::span<const IntBox> boxes, std::size_t axis, std::int64_t span, Items items,
              std::vector<Items>& runs) {
    // Ends: the item with the lowest low always fits, and what stays reaches half a span beyond it.
    while (!items.empty()) {
        std::int64_t lowest = boxes[items.front()].low[axis];
        for (const std::uint32_t item : items)
            lowest = std::min(lowest, std::int64_t{boxes[item].low[axis]});
        Items taken, left;
        for (const std::uint32_t item : items)
            (boxes[item].high[axis] <= lowest + span ? taken : left).push_back(item);
        runs.push_back(std::move(taken));
        items = std::move(left);
    }
}

}  // namespace

Tiling split_into_tiles(std::span<const Box<std::int32_t>> boxes, std::int32_t span) {
    Tiling tiling;
    Items fitting;
    for (std::uint32_t item = 0; item < boxes.size(); ++item) {
        (wider_than(boxes[item], span / 2) ? tiling.too_large : fitting).push_back(item);
    }
    tiling.tiles.push_back(std::move(fitting));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Items> runs;
        for (Items& tile : tiling.tiles)
            cut_axis(boxes, axis, span, std::move(tile), runs);
        tiling.tiles = std::move(runs);
    }
    return tiling;
}

}  // namespace tinsmith::api
