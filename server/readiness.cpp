// SPDX-License-Identifier: Apache-2.0
#include "server/readiness.hpp"

#include <exception>
#include <utility>

#include "server/log.hpp"

namespace tinsmith::server {

namespace {

std::optional<std::string> ask(const Readiness::Check& check) {
    try {
        return check();
    } catch (const std::exception& error) {
        return std::string("the check failed: ") + error.what();
    }
}

}  // namespace

void Readiness::enter(Phase phase) {
    Phase now = phase_;
    while (now < phase) {
        // Where it fails, `now` is what another thread has entered meanwhile.
        if (!phase_.compare_exchange_weak(now, phase)) continue;
        if (phase == Phase::Serving) has_started_ = true;
        return;
    }
}

void Readiness::add(std::string name, Check check) {
    auto named = std::make_shared<const Named>(Named{std::move(name), std::move(check)});
    const std::lock_guard lock(mutex_);
    checks_.push_back(std::move(named));
}

std::vector<Readiness::Refusal> Readiness::refusals() const {
    std::vector<std::shared_ptr<const Named>> checks;
    {
        const std::lock_guard lock(mutex_);
        checks = checks_;
    }
    std::vector<Refusal> refusals;
    std::string whys;
    for (const auto& named : checks) {
        const auto why = ask(named->check);
        if (!why) continue;
        refusals.push_back({"CHECK_FAILED", named->name + ": " + *why});
        whys += (whys.empty() ? "" : "; ") + refusals.back().why;
    }
    const bool fine = refusals.empty();
    if (fine_.exchange(fine) != fine) {
        if (fine) {
            log_event(LogLevel::Info, "ready_again", "ready again");
        } else {
            log_event(LogLevel::Warning, "not_ready", "not ready", {{"why", whys}});
        }
    }
    const Phase now = phase();
    if (now == Phase::Starting)
        refusals.insert(refusals.begin(), {"STARTING", "the sessions are being loaded"});
    if (now == Phase::Draining)
        refusals.insert(refusals.begin(), {"DRAINING", "the server was told to stop"});
    return refusals;
}

}  // namespace tinsmith::server
