// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace tinsmith::digest {

/// 64-bit FNV-1a over the bytes of what is added, the least significant byte first.
class Fnv {
  public:
    void add(std::uint64_t value) {
        for (int byte = 0; byte < 8; ++byte) {
            hash_ = (hash_ ^ (value & 0xffU)) * 0x100000001b3ULL;
            value >>= 8U;
        }
    }
    /// By its bits, so that -0 is not 0.
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace tinsmith::digest
