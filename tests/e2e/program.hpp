// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tinsmith::e2e {

/// A directory of one test's own, gone with the object.
class ScratchDirectory {
  public:
    ScratchDirectory();
    ~ScratchDirectory();
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

std::string content_of(const std::string& path);
void write_content(const std::string& path, const std::string& content);

/// The whole lines of a log that warn or complain, or are no events. Empty: all is well.
std::string complaints_in(const std::string& log);

/// The real binary as a child process, both of its outputs in one file. It does not outlive the
/// object. The environment's TINSMITH_PROGRAM is another binary, such as one with sanitizers.
class Program {
  public:
    Program(std::vector<std::string> arguments, const std::string& output);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void send_signal(int signal) const;
    pid_t pid() const { return pid_; }

    bool is_running();

    /// The exit code, or 128 + the signal; nothing where it still runs after that long.
    std::optional<int> wait(std::chrono::seconds longest = std::chrono::seconds(30));

    std::string output() const { return content_of(output_); }

  private:
    void collect(int options);

    const std::string output_;
    pid_t pid_ = -1;
    std::optional<int> exit_code_;
};

/// `tinsmith serve` on a free port, ready when made. `port()` is 0 where it did not come up.
class ServerUnderTest {
  public:
    explicit ServerUnderTest(std::vector<std::string> arguments = {});

    int port() const { return port_; }
    Program& program() { return *program_; }

    /// Asks it to stop, waits, and lists everything that is not as it should be at the end: the
    /// exit code, and lines of the log that warn or complain. Empty: all is well.
    std::string stop();

  private:
    ScratchDirectory scratch_;
    std::optional<Program> program_;
    int port_ = 0;
};

}  // namespace tinsmith::e2e
