// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <utility>

#include "server/limits.hpp"

namespace tinsmith::server {

/// A piece of work that others watch and may stop.
///
/// Laws: progress never falls; one thread does the work, any may look and stop; what is told to
/// stop does so when it next asks, and not at all once it is past the point of no return.
class Work {
  public:
    /// Told of progress, on the thread that does the work, whenever it has grown by a hundredth.
    using Watch = std::function<void(double)>;

    explicit Work(Watch watch = {}) : watch_(std::move(watch)) {}

    void stop() { stopped_ = true; }
    bool stopped() const { return stopped_; }
    double progress() const { return progress_; }

    /// What comes now takes this share of all that is still to do.
    void begin_stage(double share);
    /// So much of the stage is done, from 0 to 1. What is less than before is passed over.
    void at(double share);
    void finish();

  private:
    void reach(double progress);

    const Watch watch_;
    std::atomic<bool> stopped_{false};
    std::atomic<double> progress_{0.0};
    double told_ = 0.0;
    double begin_ = 0.0;  ///< of the stage
    double end_ = 0.0;
};

/// The work that this thread does; null: nobody watches.
Work* current_work();

/// While it lives, this thread does that work.
class WorkScope {
  public:
    explicit WorkScope(Work& work);
    ~WorkScope();
    WorkScope(const WorkScope&) = delete;
    WorkScope& operator=(const WorkScope&) = delete;

  private:
    Work* const before_;
};

// What handlers call whether or not somebody watches.

void begin_stage(double share);

/// Takes the share of the stage that is done; empty where nobody watches.
std::function<void(double)> stage_progress();

/// The same for readers, which go on while it says true; empty where nobody watches.
std::function<bool(double)> reading_progress();

/// Whether the work on this thread was told to stop.
bool told_to_stop();

/// True from the time on that the limits allow for one request, when the service stops, and when
/// this thread's work is stopped. Requires: `stopping` and the work outlive it.
std::function<bool()> deadline(const Limits& limits, const std::atomic<bool>& stopping);

}  // namespace tinsmith::server
