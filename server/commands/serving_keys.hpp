// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/config.hpp"
#include "server/keys/key_ring.hpp"

namespace tinsmith::server {

/// Whether that address is this machine's own and nobody else reaches it.
bool is_loopback(const std::string& host);

/// The API keys of `tinsmith serve`: where they are, whether it may start without, and when they
/// are read anew.
class ServingKeys {
  public:
    /// Requires: the settings outlive it.
    explicit ServingKeys(const ServeConfig& config);

    bool has_file() const { return !file_.empty(); }

    /// Reads the keys, makes the first one where that is wanted, and says in the log what is in
    /// force. Requires: the data folder is there, and is held. Returns why the server may not
    /// start; empty: it may.
    std::string start();

    /// Where the file cannot be read, or has faults, those of before stay in force, and the log
    /// says so.
    void read_again();

    const KeyRing& ring() const { return ring_; }

  private:
    std::string make_first_key();

    const ServeConfig& config_;
    const std::string file_;
    KeyRing ring_;
};

}  // namespace tinsmith::server
