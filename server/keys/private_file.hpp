// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// Writes a file that its owner alone may read (mode 0600), whole or not at all: readers, and
/// whoever comes after a loss of power, find the old content or the new one. Once it returns, the
/// new one is on the disk. Links are followed. Returns why not; empty: done.
std::string write_private_file(const std::string& path, std::string_view content);

/// While it lives, no other process has the turn to change that file. The lock is beside it,
/// PATH.lock, and stays there.
class FileTurn {
  public:
    /// Waits. Nothing, with the reason in `error`, where there can be no lock.
    static std::optional<FileTurn> take(const std::string& path, std::string& error);
    FileTurn(FileTurn&& other) noexcept;
    FileTurn& operator=(FileTurn&&) = delete;
    ~FileTurn();

  private:
    explicit FileTurn(int file) : file_(file) {}

    int file_;
};

}  // namespace tinsmith::server
