// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tests/durability/ledger.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {

/// The same sessions on a server that is never killed and stores nothing, given what was
/// acknowledged in the order of its versions.
class Model {
  public:
    Model() : client_(server_.port()) {}

    bool is_up() const { return server_.port() != 0; }

    /// Does what came since the last time. What goes wrong, a line for each.
    std::string follow(const std::map<std::string, SessionRecord>& sessions);

    /// What the two servers tell differently of a session.
    std::string difference(SteadyClient& other, const SessionRecord& session);

    std::string stop() { return server_.stop(); }

  private:
    struct Twin {
        std::string id;
        std::uint64_t version = 0;
    };

    std::string make(const SessionRecord& session);
    std::string do_changes(const SessionRecord& session, std::uint64_t up_to);

    ServerUnderTest server_;
    SteadyClient client_;
    std::map<std::string, Twin> twins_;  ///< by the id of the session
};

/// The body of the bundled terrain's request, for both servers.
Answer make_bundled(SteadyClient& server, const std::string& id);

}  // namespace tinsmith::e2e
