// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace tinsmith::core {

/// Spacing of doubles just above |x|: what rounding a value of that size can move it, twice over.
/// By bits, so that every compiler and library gives the same. Requires: x is finite.
inline double ulp(double x) {
    const std::uint64_t magnitude = std::bit_cast<std::uint64_t>(x) & 0x7fffffffffffffffULL;
    return std::bit_cast<double>(magnitude + 1) - std::bit_cast<double>(magnitude);
}

/// The next double towards +infinity (up) or -infinity. Requires: x is finite.
inline double neighbour(double x, bool up) {
    if (x == 0.0) return up ? std::bit_cast<double>(1ULL) : -std::bit_cast<double>(1ULL);
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    return std::bit_cast<double>((x > 0.0) == up ? bits + 1 : bits - 1);
}

}  // namespace tinsmith::core
