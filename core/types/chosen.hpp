// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tinsmith::core {

/// One of the two, by their bits: where neither is more likely, a branch would be foreseen wrongly
/// every other time, and compilers make one of `?:` when they like.
template <typename T>
inline T chosen(bool first, T one, T other) {
    constexpr std::size_t kSize = sizeof(T);  // NOLINT(bugprone-sizeof-expression): pointers, too
    static_assert(kSize == 4 || kSize == 8);
    using Bits = std::conditional_t<kSize == 4, std::uint32_t, std::uint64_t>;
    const Bits ones = std::bit_cast<Bits>(one), others = std::bit_cast<Bits>(other);
    const Bits mask = Bits{0} - Bits{first};
    return std::bit_cast<T>(others ^ ((ones ^ others) & mask));
}

}  // namespace tinsmith::core
