// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace tinsmith::core {

/// Error-free arithmetic on doubles: a result and what rounding left out of it, together exact.
/// Holds while nothing overflows or underflows, which the coordinate range ensures, and while
/// the compiler neither fuses nor reorders (-ffp-contract=off, no fast-math).
/// Sources: Dekker 1971, Knuth TAOCP 2, Shewchuk 1997.
struct Exact {
    double value;  ///< the rounded result
    double rest;   ///< exact result minus value
};

inline Exact exact_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    const double a_part = sum - b_part;
    return {sum, (a - a_part) + (b - b_part)};
}

inline Exact exact_difference(double a, double b) {
    const double difference = a - b;
    const double b_part = a - difference;
    const double a_part = difference + b_part;
    return {difference, (a - a_part) + (b_part - b)};
}

inline Exact exact_product(double a, double b) {
    constexpr double kSplitter = 134217729.0;  // 2^27 + 1: halves of 26 bits
    const double product = a * b;
    const double a_scaled = kSplitter * a;
    const double a_high = a_scaled - (a_scaled - a);
    const double a_low = a - a_high;
    const double b_scaled = kSplitter * b;
    const double b_high = b_scaled - (b_scaled - b);
    const double b_low = b - b_high;
    const double rest =
        a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return {product, rest};
}

/// An exact sum of up to N doubles, kept as non-overlapping components of growing magnitude.
/// The largest component has the sign of the whole.
template <std::size_t N>
class Expansion {  // NOLINT(cppcoreguidelines-pro-type-member-init): only `size_` parts are read
  public:
    /// Adds one double exactly. Cost: the number of components. Requires: fewer than N were added.
    void add(double x) {
        std::size_t kept = 0;
        double carry = x;
        for (std::size_t i = 0; i < size_; ++i) {
            const Exact sum = exact_sum(carry, parts_[i]);
            carry = sum.value;
            if (sum.rest != 0.0) parts_[kept++] = sum.rest;
        }
        if (carry != 0.0) parts_[kept++] = carry;
        size_ = kept;
    }

    void add(const Exact& x) {
        add(x.rest);
        add(x.value);
    }

    /// The sum rounded: right to a few units in the last place, and zero only where it is zero.
    double estimate() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < size_; ++i)
            sum += parts_[i];
        return sum;
    }

    /// The components, from the smallest on; none is zero.
    std::size_t size() const { return size_; }
    double part(std::size_t i) const { return parts_[i]; }

    int sign() const {
        if (size_ == 0) return 0;
        return parts_[size_ - 1] > 0.0 ? 1 : -1;
    }

  private:
    std::array<double, N> parts_;
    std::size_t size_ = 0;
};

}  // namespace tinsmith::core
