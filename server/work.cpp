// SPDX-License-Identifier: Apache-2.0
#include "server/work.hpp"

#include <algorithm>
#include <chrono>

namespace tinsmith::server {

namespace {

thread_local Work* mine = nullptr;

}  // namespace

void Work::begin_stage(double share) {
    begin_ = end_;
    end_ += (1.0 - end_) * share;
    reach(begin_);
}

void Work::at(double share) {
    reach(begin_ + (end_ - begin_) * std::clamp(share, 0.0, 1.0));
}

void Work::finish() {
    begin_ = end_ = 1.0;
    reach(1.0);
}

void Work::reach(double progress) {
    constexpr double kWorthTelling = 0.01;
    if (progress <= progress_) return;
    progress_ = progress;
    if (!watch_ || (progress - told_ < kWorthTelling && progress < 1.0)) return;
    told_ = progress;
    watch_(progress);
}

Work* current_work() {
    return mine;
}

WorkScope::WorkScope(Work& work) : before_(mine) {
    mine = &work;
}

WorkScope::~WorkScope() {
    mine = before_;
}

void begin_stage(double share) {
    if (mine != nullptr) mine->begin_stage(share);
}

std::function<void(double)> stage_progress() {
    if (mine == nullptr) return {};
    return [work = mine](double share) { work->at(share); };
}

std::function<bool(double)> reading_progress() {
    if (mine == nullptr) return {};
    return [work = mine](double share) {
        work->at(share);
        return !work->stopped();
    };
}

bool told_to_stop() {
    return mine != nullptr && mine->stopped();
}

std::function<bool()> deadline(const Limits& limits, const std::atomic<bool>& stopping) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto most = std::chrono::duration<double>(limits.max_edit_seconds);
    return [start, most, &stopping, work = mine] {
        return stopping.load(std::memory_order_relaxed) || (work != nullptr && work->stopped()) ||
               Clock::now() - start > most;
    };
}

}  // namespace tinsmith::server
