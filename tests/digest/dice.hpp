// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace tinsmith::digest {

/// Chance that falls alike with every compiler and standard library: the engine's numbers are laid
/// down by the C++ standard, those of the library's distributions are not.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    /// One of 0 .. count - 1.
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((engine_() >> 32U) % count);
    }
    bool one_in(std::uint32_t count) { return below(count) == 0; }
    /// From 0 up to but not 1, all 53 bits drawn. Exact.
    double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  private:
    std::mt19937_64 engine_;
};

}  // namespace tinsmith::digest
