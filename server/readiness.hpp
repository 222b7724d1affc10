// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tinsmith::server {

/// Whether this process should be sent requests: what /readyz answers.
///
/// Laws: not before it serves, not once it drains, and not while a check says no. Asking takes one
/// lock, for the time of copying a short list; the checks run outside of it.
class Readiness {
  public:
    /// In this order, never back.
    enum class Phase {
        Starting,  ///< sessions are being loaded
        Serving,
        Draining,  ///< told to stop
    };

    /// Nothing, or why not, in words for the operator. Called on any thread, several at a time; it
    /// must answer at once: a check looks at what is known and tries nothing. One that throws says
    /// no.
    using Check = std::function<std::optional<std::string>()>;

    struct Refusal {
        std::string code;  ///< "STARTING", "DRAINING" or "CHECK_FAILED"
        std::string why;
    };

    /// There is a start to wait for. Before anybody asks.
    void begin() {
        phase_ = Phase::Starting;
        has_started_ = false;
    }
    /// Goes forward, or stays.
    void enter(Phase phase);
    Phase phase() const { return phase_; }
    /// Whether all that was to be loaded has been: not where it was told to stop before that.
    bool has_started() const { return has_started_; }

    /// `name` in small letters, for answers and the log. What the check uses must live until this
    /// ends.
    void add(std::string name, Check check);

    /// Empty: ready. Logs when checks turn from yes to no and back.
    std::vector<Refusal> refusals() const;

  private:
    struct Named {
        std::string name;
        Check check;
    };

    /// Serving unless told otherwise: where nothing is loaded there is nothing to wait for.
    std::atomic<Phase> phase_{Phase::Serving};
    std::atomic<bool> has_started_{true};
    mutable std::mutex mutex_;  ///< guards the list
    std::vector<std::shared_ptr<const Named>> checks_;
    mutable std::atomic<bool> fine_{true};  ///< as last told
};

}  // namespace tinsmith::server
