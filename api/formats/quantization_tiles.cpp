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
///   low of the first item left          low + span
///        |=====================================|
///          [--]  [-----] taken          [---]     [----] left for the next run
///                                           [------]     left: reaches over
void cut_axis(std::span<const IntBox> boxes, std::size_t axis, std::int64_t span, Items items,
              std::vector<Items>& runs) {
    std::sort(items.begin(), items.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(boxes[a].low[axis], a) < std::pair(boxes[b].low[axis], b);
    });
    // Ends: the first item left always fits, and what stays reaches half a span beyond it.
    while (!items.empty()) {
        const std::int64_t limit = boxes[items.front()].low[axis] + span;
        const auto left = std::stable_partition(
            items.begin(), items.end(),
            [&](std::uint32_t item) { return boxes[item].high[axis] <= limit; });
        runs.emplace_back(items.begin(), left);
        items.erase(items.begin(), left);
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
    for (Items& tile : tiling.tiles)
        std::sort(tile.begin(), tile.end());
    return tiling;
}

}  // namespace tinsmith::api
