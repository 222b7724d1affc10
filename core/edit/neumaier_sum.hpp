// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/predicates/expansion.hpp"

namespace tinsmith::core {

/// A running sum with what rounding left out of it: right to a unit in the last place of the sum
/// of the terms' magnitudes, however many there are. The order of the terms shows in the last digit
/// alone. Source: Neumaier 1974.
class NeumaierSum {
  public:
    void add(double x) {
        const Exact sum = exact_sum(sum_, x);
        sum_ = sum.value;
        rest_ += sum.rest;
    }
    double value() const { return sum_ + rest_; }

  private:
    double sum_ = 0.0;
    double rest_ = 0.0;
};

}  // namespace tinsmith::core
