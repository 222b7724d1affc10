// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tinsmith::bench {

/// The thread's processor time: on a machine shared with others it is steadier than the wall's, and
/// on an idle one the same, for nothing measured here waits.
double now_ms();
/// The wall's clock, for what several threads do, or another process.
double wall_ms();
double median(std::vector<double> values);
double least(const std::vector<double>& values);

/// "0.41 (0.38-0.44)": the median of the ratios of pairs, and the middle half of them.
/// Requires: as many of both, one at least.
std::string ratio(const std::vector<double>& over, const std::vector<double>& under);

/// What `main` is: runs a part so many times, the usual number where none is given. Freed memory is
/// kept, as in a process that has run for a while: else the system's handing out of fresh pages is
/// what is timed.
int run_program(const char* name, int count, char** arguments, int usual_runs,
                int (*run)(const std::string& part, int runs));

}  // namespace tinsmith::bench
