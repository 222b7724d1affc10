// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <string>
#include <thread>

namespace tinsmith::e2e {

/// A server that says it is ready and then does what the path says: /v1/hangs never answers,
/// /v1/closes ends the connection, /v1/babbles is no HTTP, all others are 200 and empty.
class BadServer {
  public:
    /// Port 0: a free one.
    explicit BadServer(const std::string& address = "127.0.0.1", int port = 0);
    ~BadServer() { stop(); }
    BadServer(const BadServer&) = delete;
    BadServer& operator=(const BadServer&) = delete;

    /// 0 where it cannot listen.
    int port() const { return port_; }
    void stop();

  private:
    void serve();

    int listener_ = -1;
    int port_ = 0;
    std::list<int> held_;
    std::thread thread_;
};

}  // namespace tinsmith::e2e
