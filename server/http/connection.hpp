// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace tinsmith::server {

/// What all connections are together.
struct ConnectionTotals {
    std::atomic<std::size_t> connections{0};
    std::atomic<std::uint64_t> sent_away{0};  ///< closed to make room, since the beginning
};

/// A numeric address and a port; an empty address where the system does not tell.
using Endpoint = std::pair<std::string, int>;

/// A client's connection: its socket, and what has been read of it and not been used yet.
///
/// Laws: the socket never blocks but where a wait is given; it is closed with the connection, which
/// counts in its totals as long as it lives. Used by one thread at a time.
class Connection {
  public:
    /// What a look at the socket brought.
    enum class Got { Bytes, Nothing, End };

    /// Takes over a socket that does not block. The totals outlive the connection.
    Connection(int socket, ConnectionTotals& totals);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    int socket() const { return socket_; }
    Endpoint remote() const;
    Endpoint local() const;

    /// What has been read and not been used.
    std::string_view unread() const { return std::string_view(buffer_).substr(used_); }
    /// Reads what is there, at most `most` bytes, behind `unread`.
    Got receive(std::size_t most);
    /// Uses up the first bytes of `unread`. Requires: there are so many.
    void use(std::size_t count);
    /// Takes bytes out of `unread`, as if they had not come. Requires: there are so many.
    void cut(std::size_t begin, std::size_t count);
    /// How long the head at the beginning of `unread` is; 0: not whole yet. Empty lines before a
    /// head are used up (RFC 9112 2.2).
    std::size_t size_of_head();

    /// Whether bytes are there that have not been read. Reads none.
    bool has_more() const;
    /// Waits for bytes or the end of the connection. False: neither came.
    bool wait_readable(std::chrono::milliseconds longest) const;

    /// At least one byte, of `unread` or of the socket, waiting for it; 0: the end; -1: nothing
    /// came, or the connection is broken.
    long read(char* to, std::size_t most, std::chrono::milliseconds longest);
    /// At least one byte of the two texts, as if they were one; -1: none was taken for so long, or
    /// the connection is broken. Requires: one of them is not empty.
    long write(std::string_view first, std::string_view second, std::chrono::milliseconds longest);

    /// Tells the client that no more comes, and reads on.
    void end_sending() const;
    /// Throws away what is there, at most a mebibyte.
    Got discard();

  private:
    bool wait_for(short events, std::chrono::milliseconds longest) const;

    const int socket_;
    ConnectionTotals& totals_;
    std::string buffer_;
    std::size_t used_ = 0;
    std::size_t looked_at_ = 0;  ///< bytes of `unread` in which no head ends
};

}  // namespace tinsmith::server
