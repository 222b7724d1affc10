// SPDX-License-Identifier: Apache-2.0
#include "core/edit/box_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tinsmith::core {

namespace {

constexpr std::uint32_t kMostInALeaf = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (order_.empty()) return;
    nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
    // Ends: each node's halves are smaller than itself.
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node node = nodes_[i];
        node.box = boxes_[order_[node.first]];
        for (std::uint32_t k = node.first; k < node.last; ++k)
            node.box.include(boxes_[order_[k]]);
        if (node.last - node.first > kMostInALeaf) {
            const bool by_y = node.box.high.y - node.box.low.y > node.box.high.x - node.box.low.x;
            const auto place = [&](std::uint32_t b) {
                const Box& box = boxes_[b];
                return by_y ? box.low.y + box.high.y : box.low.x + box.high.x;
            };
            const std::uint32_t middle = node.first + (node.last - node.first) / 2;
            std::nth_element(order_.begin() + node.first, order_.begin() + middle,
                             order_.begin() + node.last, [&](std::uint32_t a, std::uint32_t b) {
                                 const double l = place(a), r = place(b);
                                 return l != r ? l < r : a < b;
                             });
            node.halves = static_cast<std::uint32_t>(nodes_.size());
            nodes_.push_back({{}, node.first, middle, 0});
            nodes_.push_back({{}, middle, node.last, 0});
        }
        nodes_[i] = node;
    }
}

void BoxTree::near(const Box& box, std::vector<std::uint32_t>& found) const {
    found.clear();
    if (nodes_.empty()) return;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (!node.box.meets(box)) continue;
        if (node.halves != 0) {
            open.push_back(node.halves);
            open.push_back(node.halves + 1);
            continue;
        }
        for (std::uint32_t k = node.first; k < node.last; ++k) {
            if (boxes_[order_[k]].meets(box)) found.push_back(order_[k]);
        }
    }
    std::sort(found.begin(), found.end());
}

}  // namespace tinsmith::core
