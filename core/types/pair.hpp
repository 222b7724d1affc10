// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tinsmith::core {

/// Two doubles in one register, for what takes the same steps for both. Each step rounds as that of
/// a double does.
typedef double Pair __attribute__((vector_size(16)));  // NOLINT(modernize-use-using): GCC 12

inline double sum_of(Pair p) {
    return p[0] + p[1];
}

/// Of both.
inline Pair magnitudes(Pair p) {
    typedef std::int64_t Bits __attribute__((vector_size(16)));  // NOLINT(modernize-use-using)
    return reinterpret_cast<Pair>(reinterpret_cast<Bits>(p) & INT64_MAX);
}

}  // namespace tinsmith::core
