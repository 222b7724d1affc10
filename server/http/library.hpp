// SPDX-License-Identifier: Apache-2.0
// cpp-httplib without its sockets and threads: it reads heads and bodies and writes heads. With
// protocol.cpp, which includes this, the only place that knows it. It must build against 0.11
// (Debian 12) and 0.18 (Debian 13).
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <tuple>

#include <httplib.h>

#include "server/http/connection.hpp"
#include "server/http/pace.hpp"

namespace tinsmith::server {

/// A connection as the library sees it: it reads heads and bodies and writes heads.
class ConnectionStream final : public httplib::Stream {
  public:
    /// `longest`: for one read or write. What it writes has to be taken at that pace.
    ConnectionStream(Connection& connection, std::chrono::seconds longest, Pace pace)
        : connection_(connection), longest_(longest), pace_(pace) {}

    bool is_readable() const override { return true; }
    bool is_writable() const override { return true; }

    ssize_t read(char* to, std::size_t size) override {
        // The client may wait for "100 Continue" before it sends more.
        if (!head_.empty() && !flush()) return -1;
        return connection_.read(to, size, longest_);
    }

    ssize_t write(const char* bytes, std::size_t size) override {
        head_.append(bytes, size);
        return static_cast<ssize_t>(size);
    }

    /// Forgets what has been written and not sent.
    void forget() { head_.clear(); }

    /// Sends what the library has written, and a body after it. False: it was not taken.
    bool flush(std::string_view body = {}) {
        std::string_view head = head_;
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t sent = 0; !head.empty() || !body.empty();) {
            const long part = connection_.write(head, body, longest_);
            if (part <= 0) return false;
            const auto count = static_cast<std::size_t>(part);
            const std::size_t of_head = std::min(count, head.size());
            head.remove_prefix(of_head);
            body.remove_prefix(count - of_head);
            sent += count;
            if (pace_.is_too_slow(start, sent) && !(head.empty() && body.empty())) return false;
        }
        head_.clear();
        return true;
    }

    void get_remote_ip_and_port(std::string& address, int& port) const override {
        std::tie(address, port) = connection_.remote();
    }
    void get_local_ip_and_port(std::string& address, int& port) const override {
        std::tie(address, port) = connection_.local();
    }

    /// None: the library compares it with what select(2) can bear, which is never asked here.
    socket_t socket() const override { return INVALID_SOCKET; }

  private:
    Connection& connection_;
    const std::chrono::seconds longest_;
    const Pace pace_;
    std::string head_;  ///< written and not sent: it goes out with the body, in one system call
};

/// A request that nobody sends, and whose answer nobody reads.
class Rehearsal final : public httplib::Stream {
  public:
    bool is_readable() const override { return true; }
    bool is_writable() const override { return true; }
    ssize_t read(char* to, std::size_t size) override {
        const std::size_t count = request_.copy(to, size);
        request_.remove_prefix(count);
        return static_cast<ssize_t>(count);
    }
    ssize_t write(const char* /*bytes*/, std::size_t size) override {
        return static_cast<ssize_t>(size);
    }
    void get_remote_ip_and_port(std::string& /*address*/, int& /*port*/) const override {}
    void get_local_ip_and_port(std::string& /*address*/, int& /*port*/) const override {}
    socket_t socket() const override { return INVALID_SOCKET; }

  private:
    std::string_view request_ = "GET / HTTP/1.1\r\n\r\n";
};

/// The library's server without its sockets and threads.
class Library : public httplib::Server {
  public:
    /// The library makes its table of methods when it reads a first request, behind a lock that a
    /// checker of threads does not see in code built without it: so that request is one of ours.
    Library() {
        Rehearsal request;
        bool closed = false;
        exchange(*this, request, closed);
    }

    /// Reads one request and writes its answer. False: that failed. Sets `closed` where the library
    /// takes the request for the last.
    bool exchange(ConnectionStream& stream, bool& closed) {
        return exchange(*this, stream, closed);
    }

  private:
    /// A template, so that what one of the releases does not have is not looked at.
    template <typename Self>
    static bool exchange(Self& self, httplib::Stream& stream, bool& closed) {
        if constexpr (requires { self.process_request(stream, false, closed, nullptr); }) {
            return self.process_request(stream, false, closed, nullptr);
        } else {
            std::string remote, local;
            int remote_port = 0, local_port = 0;
            stream.get_remote_ip_and_port(remote, remote_port);
            stream.get_local_ip_and_port(local, local_port);
            return self.process_request(stream, remote, remote_port, local, local_port, false,
                                        closed, nullptr);
        }
    }
};

}  // namespace tinsmith::server
