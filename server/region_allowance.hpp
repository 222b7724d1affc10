// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/types/error.hpp"
#include "server/regions.hpp"

namespace tinsmith::server {

/// What is left of the limits.
class RegionAllowance {
  public:
    explicit RegionAllowance(const RegionLimits& limits)
        : limits_(limits), left_(limits.max_visits) {}

    /// False once the limits are met, and from then on. Asks whether to stop now and then.
    bool spend(std::uint64_t visits) {
        if (refused_) return false;
        if (visits > left_) {
            refused_ =
                core::Error{core::ErrorCode::CrossingBudget,
                            "the regions have more than " + std::to_string(limits_.max_visits) +
                                " triangles and edges together with those of the polygons "
                                "near them; ask for fewer at a time, or have max_crossings raised",
                            {}};
            return false;
        }
        left_ -= visits;
        constexpr std::uint64_t kAskEvery = 4096;
        spent_ += visits;
        if (spent_ < kAskEvery) return true;
        spent_ = 0;
        return goes_on();
    }

    /// An id, or a group, takes the room of some triangles.
    bool spend_ids(std::size_t count) {
        constexpr std::uint64_t kTrianglesOfAnId = 8;
        return spend(kTrianglesOfAnId * count);
    }

    /// Ids that an answer of one piece tells beside the triangles. False where there are too many
    /// of them for that.
    bool spend_told(std::size_t ids) {
        constexpr std::size_t kMost = 500'000;
        if (refused_) return false;
        told_ += ids;
        if (told_ > kMost)
            refused_ = core::Error{core::ErrorCode::CrossingBudget,
                                   "the polygons overlap so often that more than " +
                                       std::to_string(kMost) +
                                       " of their ids would be told; ask without regions, or for "
                                       "the regions one by one",
                                   {}};
        return !refused_;
    }

    bool goes_on() {
        if (!refused_ && limits_.cancelled && limits_.cancelled())
            refused_ = core::Error{core::ErrorCode::Cancelled, "the question was stopped", {}};
        return !refused_;
    }

    const std::optional<core::Error>& refused() const { return refused_; }

  private:
    const RegionLimits& limits_;
    std::uint64_t left_;
    std::size_t told_ = 0;
    std::uint64_t spent_ = 0;  ///< since the last question
    std::optional<core::Error> refused_;
};

}  // namespace tinsmith::server
