// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tinsmith::server {

/// This process as the kernel sees it, by /proc; zero what cannot be read.
struct ProcessFigures {
    double start_seconds = 0.0;  ///< since 1970
    double cpu_seconds = 0.0;
    std::uint64_t resident_bytes = 0;
    std::uint64_t virtual_bytes = 0;
    std::uint64_t open_files = 0;
    std::uint64_t max_files = 0;
};

ProcessFigures process_figures();

}  // namespace tinsmith::server
