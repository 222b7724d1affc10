// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "tests/durability/histories.hpp"
#include "tests/durability/ledger.hpp"
#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"

namespace tinsmith::e2e {

/// The sessions that clients work on, by slots: the first two stay, the others come and go.
struct Slots {
    static constexpr int kBundled = 0;
    static constexpr int kStaying = 1;
    static constexpr int kCount = 5;
    static constexpr int kPosts = 24;  ///< along a side of the grids
    /// Where polygons go in the bundled terrain, and in the grids.
    static constexpr Extent kBundledExtent{748500, 4018500, 10000, 10000};
    static constexpr Extent kGridExtent{0, 0, kPosts - 1, kPosts - 1};
};

/// One that wishes for one thing after the other, and for each until it is acknowledged: through
/// restarts, and where the answer was lost on the way.
class CrashClient {
  public:
    CrashClient(int number, int clients, std::uint64_t seed, Ledger& ledger)
        : number_(number), clients_(clients), dice_(seed), ledger_(ledger) {}

    /// Works until it gets no answer while the server is `down`.
    void run(int port, const std::atomic<bool>& down);

    /// Has what is not acknowledged yet acknowledged by a server that stays up. False: it does not
    /// come to that.
    bool settle(int port);

    const std::optional<Intent>& pending() const { return pending_; }
    void forget_pending() { pending_.reset(); }

  private:
    bool owns(int slot) const { return slot % clients_ == number_; }
    Intent next(SteadyClient& server);
    Intent renew(int slot);
    Intent polygons(const std::string& session, const Extent& where);
    Intent edit(const std::string& session);
    Intent owner_change(SteadyClient& server, const std::string& session);
    Intent question(const std::string& session);
    std::string new_key();

    /// True: acknowledged, one way or the other.
    bool attempt(SteadyClient& server, Intent& intent);
    std::optional<bool> was_made_before(SteadyClient& server, const Intent& intent);
    void note(const Intent& intent, const Answer& answer);
    void note_session(const Intent& intent, const Answer& answer);

    const int number_;
    const int clients_;
    Dice dice_;
    Ledger& ledger_;
    std::optional<Intent> pending_;
    int keys_ = 0;
};

}  // namespace tinsmith::e2e
