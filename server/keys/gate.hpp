// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/http_message.hpp"
#include "server/keys/key_ring.hpp"

namespace tinsmith::server {

/// Who may ask: judges requests by their heads, before a byte of their bodies is read.
///
/// Laws: where keys are wanted, nothing under /v1 and no figures are told without one. What is
/// there for everyone: the page, the description of the interface, /healthz and /readyz, OPTIONS
/// (browsers ask it without a key). A key that is not known and a text that is none are refused in
/// the same words. What passes has `asker` set, and holds one of the key's requests in flight until
/// it and its copies are gone.
/// Cost: a SHA-256, and a comparison for each key. From any thread.
class Gate {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Clock = std::function<Time()>;

    /// The ring outlives the gate, and the gate the requests.
    explicit Gate(const KeyRing& keys, Clock clock = std::chrono::steady_clock::now);

    /// What is answered instead; nothing: go on, the request says who asks.
    std::optional<Response> admit(Request& request);

  private:
    /// Of one key, by its id.
    struct Use {
        std::size_t in_flight = 0;
        double tokens = 0.0;  ///< requests that it may begin now
        std::optional<Time> filled{};
    };
    class Pass;

    static double take_token(Use& use, double rate, Time now);

    const KeyRing& keys_;
    const Clock clock_;
    std::mutex mutex_;                 ///< guards the next
    std::map<std::string, Use> uses_;  ///< of keys that have quotas for it
};

}  // namespace tinsmith::server
