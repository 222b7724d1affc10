// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/point.hpp"

namespace tinsmith::api {

/// Gives each position one number, however often it comes: the first that it was given. Equal are
/// the same numbers to the last bit; both noughts are one. The order is that of first use.
/// Cost: constant for each; 8 bytes for each position beside the positions.
class VertexWelder {
  public:
    explicit VertexWelder(std::vector<core::Point3>& vertices)
        : vertices_(vertices), slots_(64, 0) {}

    std::uint32_t number_of(const core::Point3& p) {
        if (std::uint32_t& slot = slot_of(p); slot != 0) return slot - 1;
        vertices_.push_back(p);
        if (vertices_.size() * 2 > slots_.size()) {
            grow();
        } else {
            slot_of(p) = static_cast<std::uint32_t>(vertices_.size());
        }
        return static_cast<std::uint32_t>(vertices_.size() - 1);
    }

    /// The same, but for positions that are there only; UINT32_MAX: it is not.
    std::uint32_t find(const core::Point3& p) { return slot_of(p) - 1; }

  private:
    static std::uint64_t mixed(std::uint64_t hash, double value) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9e3779b97f4a7c15ULL;
        return hash ^ (hash >> 32);
    }
    /// The slot of that position, or the empty one where it would be: at most half are taken.
    std::uint32_t& slot_of(const core::Point3& p) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = mixed(mixed(mixed(key_, p.x), p.y), p.z) & mask;
        while (slots_[at] != 0 && !(vertices_[slots_[at] - 1] == p))
            at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        slots_.assign(slots_.size() * 2, 0);
        for (std::uint32_t v = 0; v < vertices_.size(); ++v)
            slot_of(vertices_[v]) = v + 1;
    }

    std::vector<core::Point3>& vertices_;
    std::vector<std::uint32_t> slots_;  ///< number + 1; 0: empty
    /// Where that lies in memory, which nobody knows who sends a mesh: positions chosen so that
    /// they fall together do so for one key only. No number depends on it.
    const std::uint64_t key_ = reinterpret_cast<std::uintptr_t>(slots_.data());
};

}  // namespace tinsmith::api
