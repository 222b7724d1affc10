// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.hpp"

#include <algorithm>
#include <iostream>

#include <unistd.h>

namespace tinsmith::server {

ProgressBar::ProgressBar() : visible_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::name(std::string_view stage) {
    stage_ = stage;
    draw();
}

void ProgressBar::show(double done) {
    done_ = std::clamp(done, 0.0, 1.0);
    draw();
}

void ProgressBar::draw() const {
    static constexpr int kWidth = 30;
    static constexpr int kPercent = 100;
    if (!visible_) return;
    const auto full = static_cast<std::size_t>(kWidth * done_);
    std::cerr << "\r\033[K[" << std::string(full, '#') << std::string(kWidth - full, '.') << "] "
              << static_cast<int>(kPercent * done_) << "% " << stage_ << std::flush;
}

void ProgressBar::clear() {
    if (visible_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace tinsmith::server
