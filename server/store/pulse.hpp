// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "server/store/journal.hpp"

namespace tinsmith::server::store {

/// How the writer is: health and figures. Thread-safe; its lock is held for a copy at most, never
/// over a commit.
class Pulse {
  public:
    using Duration = std::chrono::steady_clock::duration;

    void note_commit(Duration time, std::size_t entries, std::size_t bytes);
    void note_failure(const std::string& why);
    void note_checkpoint(Duration time);
    void note_checkpoint_failure(const std::string& why);
    void note_swept(std::uint64_t rows);
    void note_answers_dropped(std::uint64_t answers);

    /// Whether the last commit, and the last checkpoint, failed.
    bool is_failing() const;
    bool checkpoint_is_failing() const;
    JournalHealth health() const;
    JournalFigures figures() const;

  private:
    static bool fail(JournalHealth& health, const std::string& why);

    mutable std::mutex mutex_;
    JournalHealth commits_;
    JournalHealth checkpoints_;
    JournalFigures figures_;
};

}  // namespace tinsmith::server::store
