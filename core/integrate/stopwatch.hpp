// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace tinsmith::core {

/// Adds the time since the last lap to one stage or another; all laps together are the whole.
class Stopwatch {
  public:
    explicit Stopwatch(const std::function<double()>& clock) : clock_(clock) {
        if (clock_) last_ = clock_();
    }
    void lap(double& stage) {
        if (!clock_) return;
        const double now = clock_();
        stage += now - last_;
        last_ = now;
    }

  private:
    const std::function<double()>& clock_;
    double last_ = 0.0;
};

}  // namespace tinsmith::core
