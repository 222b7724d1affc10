// SPDX-License-Identifier: Apache-2.0
#include "server/store/pulse.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "server/log.hpp"

namespace tinsmith::server::store {

/// Whether it was fine before.
bool Pulse::fail(JournalHealth& health, const std::string& why) {
    const bool first = health.fine;
    if (first) health.since = std::chrono::system_clock::now();
    health.fine = false;
    health.why = why;
    return first;
}

void Pulse::note_commit(Duration time, std::size_t entries, std::size_t bytes) {
    const double seconds = std::chrono::duration<double>(time).count();
    std::unique_lock lock(mutex_);
    const bool first = !commits_.fine;
    commits_ = {};
    ++figures_.commits;
    figures_.entries += entries;
    figures_.largest_group = std::max<std::uint64_t>(figures_.largest_group, entries);
    figures_.written_bytes += bytes;
    figures_.commit_seconds += seconds;
    const auto& bounds = JournalFigures::kSeconds;
    const auto place = std::lower_bound(bounds.begin(), bounds.end(), seconds);
    ++figures_.commits_within[static_cast<std::size_t>(std::distance(bounds.begin(), place))];
    lock.unlock();
    if (first) log_event(LogLevel::Info, "journal_recovered", "the disk takes commits again");
}

void Pulse::note_failure(const std::string& why) {
    std::unique_lock lock(mutex_);
    ++figures_.failures;
    const bool first = fail(commits_, why);
    lock.unlock();
    if (first) log_event(LogLevel::Error, "journal_failed", why);
}

void Pulse::note_checkpoint(Duration time) {
    const std::lock_guard lock(mutex_);
    checkpoints_ = {};
    ++figures_.checkpoints;
    figures_.checkpoint_seconds += std::chrono::duration<double>(time).count();
}

void Pulse::note_checkpoint_failure(const std::string& why) {
    std::unique_lock lock(mutex_);
    const bool first = fail(checkpoints_, why);
    lock.unlock();
    if (first) log_event(LogLevel::Error, "journal_failed", why);
}

void Pulse::note_swept(std::uint64_t rows) {
    const std::lock_guard lock(mutex_);
    figures_.swept_rows += rows;
}

void Pulse::note_answers_dropped(std::uint64_t answers) {
    const std::lock_guard lock(mutex_);
    figures_.answers_dropped += answers;
}

bool Pulse::is_failing() const {
    const std::lock_guard lock(mutex_);
    return !commits_.fine || !checkpoints_.fine;
}

bool Pulse::checkpoint_is_failing() const {
    const std::lock_guard lock(mutex_);
    return !checkpoints_.fine;
}

JournalHealth Pulse::health() const {
    const std::lock_guard lock(mutex_);
    return commits_.fine ? checkpoints_ : commits_;
}

JournalFigures Pulse::figures() const {
    const std::lock_guard lock(mutex_);
    return figures_;
}

}  // namespace tinsmith::server::store
