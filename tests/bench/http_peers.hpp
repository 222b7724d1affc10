// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace tinsmith::bench {

/// A program that was started, ended when this ends.
class Program {
  public:
    explicit Program(const std::vector<std::string>& words);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    bool is_running();
    /// Bytes of memory that it has now.
    std::size_t resident_bytes() const;
    /// The most that it has had.
    std::size_t peak_bytes() const;

  private:
    pid_t pid_ = -1;
};

struct Answer {
    int status = 0;
    std::string body;
};

/// One connection to 127.0.0.1 that is kept, as a browser keeps it. Opened anew where the other
/// side says that it closes it. Throws where that happens unsaid, or an answer comes without a
/// Content-Length.
class Connection {
  public:
    explicit Connection(int port);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// `headers` are whole lines, each with its end. The answer's bytes are read into memory that
    /// is used again.
    const Answer& ask(std::string_view method, std::string_view path, std::string_view headers,
                      std::string_view body = {});

  private:
    void open();

    int port_;
    int socket_ = -1;
    std::string request_;
    std::string head_;
    Answer answer_;
};

/// Waits until the file is there and holds a port, while the program runs.
int port_in(const std::string& file, Program& program);

}  // namespace tinsmith::bench
