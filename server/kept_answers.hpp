// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// The answers to requests that had an Idempotency-Key, kept so that a retry is answered and not
/// done again.
///
/// Laws: of requests with one key in one scope, one at a time is let through, whatever the threads
/// do; once it has ended with an answer, none is let through for as long as that is kept. An answer
/// is kept for `age`, or until `per_scope` others of its scope came after it. One that takes more
/// than a share of the bytes is kept without its body: the retry is told that, and still not done
/// again. Where all take more than `bytes`, the scope that takes the most gives its oldest body,
/// and so on; only when there are none left are its oldest keys forgotten. So nobody loses an
/// answer to others who keep more. A key whose request is running is never dropped. Not promised:
/// memory of a key that has been dropped; and over a restart that of what is not restored.
class KeptAnswers {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Clock = std::function<Time()>;

    struct Bounds {
        std::size_t bytes = std::size_t{64} << 20;
        std::size_t per_scope = 10'000;
        std::chrono::seconds age = std::chrono::hours(24);
    };

    /// A session's birth, or of what belongs to none the API key, or empty; and the client's key.
    using Name = std::pair<std::string, std::string>;

    struct GoOn {};          ///< the first of its kind: do it, then `keep` or `drop`
    struct OtherRequest {};  ///< the key came with another request before
    struct StillRunning {};
    struct NoBody {};  ///< done, but the answer was too large
    using Verdict = std::variant<GoOn, Response, OtherRequest, StillRunning, NoBody>;

    explicit KeptAnswers(Bounds bounds, Clock clock = std::chrono::steady_clock::now)
        : bounds_(bounds), clock_(std::move(clock)) {}

    /// `print` tells requests apart: equal for equal ones. After GoOn the caller must end with one
    /// of `keep` and `drop`.
    Verdict begin(const Name& name, const std::string& print);
    /// A number of its own for what was kept.
    std::uint64_t keep(const Name& name, const Response& answer);
    void drop(const Name& name) noexcept;

    /// Drops what was kept under that number, if it is still there: the answer has turned out to be
    /// that of a request that did nothing. The next one with its key is let through.
    /// Cost: linear in the answers of its scope.
    void take_back(const Name& name, std::uint64_t number) noexcept;

    /// Drops all of one scope, but for what is running.
    void forget(const std::string& scope);

    /// The answer under that name; nothing where there is none, or not all of it.
    std::optional<Response> find(const Name& name) const;
    /// Keeps an answer that was given so long ago, unless there is one under the name.
    void restore(const Name& name, const std::string& print, const Response& answer,
                 std::chrono::seconds age);
    /// Called with each answer that is kept whole, outside of the lock. Set before the first.
    std::function<void(const Name&, const std::string& print, const Response&)> when_kept;

    std::size_t size() const;
    std::size_t bytes() const;

  private:
    struct Entry {
        std::string print;
        bool running = true;
        bool whole = true;
        Response answer;
        std::size_t bytes = 0;
        std::uint64_t number = 0;  ///< once it is not running
        Time since;
        std::list<Name>::iterator place;  ///< in `order_`, once it is not running
    };
    using Entries = std::map<Name, Entry>;

    /// What is kept of one scope.
    struct Scope {
        std::deque<Name> names;  ///< in the order of `order_`
        std::size_t bare = 0;    ///< so many in front are without body
        std::size_t bytes = 0;
    };
    using Scopes = std::map<std::string, Scope>;

    void fill(Entries::iterator place, const Response& answer, Time since);
    void make_room();
    Scopes::iterator largest(bool with_bodies);
    void take_oldest_body(Scope& scope);
    void count(Scope& scope, Entry& entry, std::size_t bytes);
    void erase(Entries::iterator entry);

    const Bounds bounds_;
    const Clock clock_;
    mutable std::mutex mutex_;
    Entries entries_;
    std::list<Name> order_;  ///< of those that are kept, the oldest in front
    Scopes scopes_;          ///< the same by scope
    std::size_t bytes_ = 0;
    std::uint64_t count_ = 0;
};

}  // namespace tinsmith::server
