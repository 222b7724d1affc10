// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>

namespace tinsmith::server::store {

/// A folder that one process serves from, held by a lock on the file `lock` in it. The system lets
/// go of it when the process ends, in whatever way.
class FolderLock {
  public:
    /// Makes the folder, for its owner alone, where it is not there. The text says why not.
    static std::variant<FolderLock, std::string> take(const std::filesystem::path& folder);

    FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
    FolderLock& operator=(FolderLock&&) = delete;
    ~FolderLock();

  private:
    explicit FolderLock(int file) : file_(file) {}
    int file_;
};

}  // namespace tinsmith::server::store
