// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tinsmith::server {

/// Sets of polygons, each kept once however many triangles or edges have it: these keep its number.
///
/// Laws: polygons are added in growing order, so that a set is its largest member and the set of
/// the others; equal sets have equal numbers.
class PolygonGroups {
  public:
    using Id = std::uint32_t;
    static constexpr Id kNone = 0;

    /// From here on this polygon is added. Requires: it is larger than any before.
    void begin(std::size_t polygon) {
        polygon_ = polygon;
        with_.clear();
        last_ = {};
    }

    /// The group with the polygon; the group itself where it is in there.
    /// Cost: next to nothing for the group that was last asked about, else a lookup.
    Id with(Id group) {
        if (last_.second != kNone && (group == last_.first || group == last_.second))
            return last_.second;
        if (group != kNone && nodes_[group].polygon == polygon_) return group;
        const auto [found, is_new] = with_.try_emplace(group, static_cast<Id>(nodes_.size()));
        if (is_new) nodes_.push_back({polygon_, group, nodes_[group].size + 1});
        last_ = *found;
        return found->second;
    }

    std::size_t count() const { return nodes_.size(); }
    std::size_t size(Id group) const { return nodes_[group].size; }

    /// In growing order.
    std::vector<std::size_t> members(Id group) const {
        std::vector<std::size_t> all(size(group));
        for (; group != kNone; group = nodes_[group].others)
            all[size(group) - 1] = nodes_[group].polygon;
        return all;
    }

  private:
    struct Node {
        std::size_t polygon = 0;  ///< the largest member
        Id others = kNone;
        std::uint32_t size = 0;
    };
    std::vector<Node> nodes_{Node{}};
    std::size_t polygon_ = 0;
    std::unordered_map<Id, Id> with_;  ///< of this polygon
    std::pair<Id, Id> last_;
};

}  // namespace tinsmith::server
