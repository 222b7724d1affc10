// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/turns.hpp"

#include <cstddef>
#include <cstdio>

#include "tests/bench/timing.hpp"

namespace tinsmith::bench {

Turns take_turns(const std::vector<Side>& sides, int runs) {
    Turns turns(sides.size());
    for (int run = 0; run <= runs; ++run) {
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const double ms = sides[i]();
            if (run > 0) turns[i].push_back(ms);
        }
    }
    return turns;
}

std::string milliseconds(const std::vector<double>& runs) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3g (%.3g)", median(runs), least(runs));
    return text;
}

}  // namespace tinsmith::bench
