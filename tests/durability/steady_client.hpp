// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

/// A client that keeps its connection as long as the server does.
class SteadyClient {
  public:
    explicit SteadyClient(int port, int longest_seconds = 60)
        : port_(port), longest_seconds_(longest_seconds) {}

    /// One request, once: status 0 where no answer came, also where the server had just closed a
    /// connection that idled.
    Answer try_once(const std::string& method, const std::string& target,
                    const std::vector<std::string>& headers = {}, const std::string& body = {}) {
        if (!connection_) connection_ = std::make_unique<Connection>(port_, longest_seconds_);
        connection_->send(request_text(method, target, headers, body));
        Answer answer = connection_->read(method == "HEAD");
        if (answer.status == 0 || answer.header("connection") == "close") connection_.reset();
        return answer;
    }

    /// For requests that may come twice.
    Answer ask(const std::string& method, const std::string& target,
               const std::vector<std::string>& headers = {}, const std::string& body = {}) {
        const bool is_used = connection_ != nullptr;
        Answer answer = try_once(method, target, headers, body);
        if (answer.status == 0 && is_used) answer = try_once(method, target, headers, body);
        return answer;
    }

    /// Sends it and does not wait for what comes.
    void send_and_leave(const std::string& method, const std::string& target,
                        const std::vector<std::string>& headers, const std::string& body) {
        connection_.reset();
        Connection(port_).send(request_text(method, target, headers, body));
    }

  private:
    int port_;
    int longest_seconds_;
    std::unique_ptr<Connection> connection_;
};

}  // namespace tinsmith::e2e
