// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tinsmith::bench {

/// One of those that are compared: does the work and says how many milliseconds it took, by the
/// clock that it thinks right. What it must prepare for each run is not in them.
using Side = std::function<double()>;

/// Milliseconds of each side, run by run.
using Turns = std::vector<std::vector<double>>;

/// The sides one after the other, so many times, after one time that warms up and is not kept. So
/// whatever else the machine does is done to all of them alike.
Turns take_turns(const std::vector<Side>& sides, int runs);

/// "12.3 (11.9)": median and minimum.
std::string milliseconds(const std::vector<double>& runs);

}  // namespace tinsmith::bench
