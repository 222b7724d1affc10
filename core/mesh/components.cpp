// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/components.hpp"

#include <algorithm>

namespace tinsmith::core {

namespace {

/// Joins slots to sets, each of which has its lowest slot for a root.
class Sets {
  public:
    explicit Sets(std::size_t count) { above_.reserve(count); }

    void add() { above_.push_back(static_cast<std::uint32_t>(above_.size())); }

    std::uint32_t root(std::uint32_t slot) {
        // Ends: what is above a slot is lower. Each step halves the way for those that come later.
        while (above_[slot] != slot) {
            above_[slot] = above_[above_[slot]];
            slot = above_[slot];
        }
        return slot;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        above_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> above_;
};

}  // namespace

std::vector<TriangleId> find_components(const Tin& tin) {
    const auto count = static_cast<std::uint32_t>(tin.triangle_count());
    Sets sets(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        sets.add();
        for (const Side twin : tin.triangle({t}).twins) {
            if (twin.valid() && twin.triangle().value < t) sets.join(t, twin.triangle().value);
        }
    }
    std::vector<TriangleId> found;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (sets.root(t) == t) found.push_back({t});
    }
    return found;
}

}  // namespace tinsmith::core
