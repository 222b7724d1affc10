// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types/point.hpp"

namespace tinsmith::test {

/// 113 bits: differences of doubles within a factor of 2^60 of each other are exact, and so are
/// their products, so that signs of determinants are right without any code of the core.
__extension__ typedef __float128 Quad;

struct QuadPoint {
    Quad x;
    Quad y;
};

inline Quad area(core::Point2 a, core::Point2 b, core::Point2 c) {
    return (Quad(a.x) - Quad(c.x)) * (Quad(b.y) - Quad(c.y)) -
           (Quad(a.y) - Quad(c.y)) * (Quad(b.x) - Quad(c.x));
}

inline int sign(Quad x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

}  // namespace tinsmith::test
