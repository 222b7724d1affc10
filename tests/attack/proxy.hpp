// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {

/// HAProxy with docker/haproxy.cfg before a server of this machine, as a child process that does
/// not outlive the object.
class Proxy {
  public:
    /// Texts of the configuration, and what stands there instead.
    using Changes = std::vector<std::pair<std::string, std::string>>;

    explicit Proxy(int server_port, const Changes& changes = {});
    /// `server` is a name or an address, with its port.
    explicit Proxy(const std::string& server, const Changes& changes = {});
    ~Proxy();
    Proxy(const Proxy&) = delete;
    Proxy& operator=(const Proxy&) = delete;

    /// Where HAProxy is; empty where it is not installed.
    static std::string program();

    /// 0 where it did not come up.
    int port() const { return port_; }
    pid_t pid() const { return pid_; }
    bool is_running() const;
    std::string output() const { return content_of(output_); }

  private:
    ScratchDirectory scratch_;
    std::string output_;
    int port_ = 0;
    pid_t pid_ = -1;
};

}  // namespace tinsmith::e2e
