// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.hpp"

#include <iostream>
#include <string>

#include <unistd.h>

namespace tinsmith::server {

Progress::Progress(int stages) : stages_(stages), visible_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    clear();
}

void Progress::next(std::string_view name) {
    static constexpr int kWidth = 30;
    if (!visible_) return;
    const auto done = static_cast<std::size_t>(kWidth * stage_ / stages_);
    ++stage_;
    std::cerr << "\r\033[K[" << std::string(done, '#') << std::string(kWidth - done, '.') << "] "
              << stage_ << "/" << stages_ << " " << name << std::flush;
}

void Progress::clear() {
    if (visible_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace tinsmith::server
