// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tinsmith::e2e {

/// An answer as it came over the wire; status 0: none came.
struct Answer {
    int status = 0;
    std::map<std::string, std::string> headers;  ///< lower-case names
    std::string body;

    std::string header(const std::string& name) const {
        const auto found = headers.find(name);
        return found == headers.end() ? "" : found->second;
    }
};

/// A connection to 127.0.0.1, with a reader of HTTP/1.1 of our own: what is tested is not also
/// the judge. Every read gives up after so many seconds.
class Connection {
  public:
    explicit Connection(int port, int longest_seconds = 10);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Bytes as they are. Goes on where the server closes early.
    void send(std::string_view bytes) const;

    /// The same. False: the server has closed, or takes nothing for that long.
    bool try_send(std::string_view bytes) const;

    /// No more bytes will come from this side.
    void end_sending() const;

    /// From here on no faster than that.
    void read_at_most(std::size_t bytes_a_second) { bytes_a_second_ = bytes_a_second; }

    /// The next answer. `to_head`: it has no body whatever its headers say.
    Answer read(bool to_head = false);

    /// Waits for the end of the connection. False: bytes came instead, or nothing for that long.
    bool is_closed();

  private:
    bool fill();

    int socket_ = -1;
    std::size_t bytes_a_second_ = 0;  ///< 0: as fast as it comes
    std::string buffer_;
};

/// A request in full, with Host and, where there is a body or a method that wants one,
/// Content-Length.
std::string request_text(const std::string& method, const std::string& target,
                         const std::vector<std::string>& headers = {},
                         const std::string& body = {});

/// One request on a connection of its own.
Answer ask(int port, const std::string& method, const std::string& target,
           const std::vector<std::string>& headers = {}, const std::string& body = {});

}  // namespace tinsmith::e2e
