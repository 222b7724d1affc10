// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tinsmith::store_tests {

/// A file system for SQLite, over the usual one, that can lose its power and refuse its service.
///
/// What is written can be read at once, as from a system's buffers; it is safe once its file was
/// synced. Nothing is ever synced for real. `cut` ends all service; `restore` puts the files into
/// the state of their last syncs, with none or some of the later writes, each whole or torn between
/// sectors of 512 bytes. After a sync that failed its writes are never made safe by another one, as
/// on Linux: only by being written again. The removal of a file may be undone too. A new name in a
/// folder is safe with the file's first sync, for SQLite then syncs the folder.
class FailingDisk {
  public:
    enum class Work { Write, Sync };
    enum class Fault { Full, Io };

    /// `name`: by which SQLite is told to use it.
    explicit FailingDisk(std::string name);
    /// Requires: all its files are closed.
    ~FailingDisk();
    FailingDisk(const FailingDisk&) = delete;
    FailingDisk& operator=(const FailingDisk&) = delete;

    const std::string& name() const { return name_; }

    /// The work after that number of others fails, and `times` in all.
    void fail(Work work, Fault fault, std::uint64_t after, std::uint64_t times);
    void mend();
    /// How often it failed since it was told to.
    std::uint64_t failures() const;

    void cut();
    bool is_cut() const;
    /// Cuts right after the n-th sync from now.
    void cut_after_syncs(std::uint64_t syncs);
    /// No seed: nothing that was not synced is kept. Requires: all files are closed.
    void restore(std::optional<std::uint64_t> seed);

    /// That were done, of all files.
    std::uint64_t syncs() const;
    /// Of write-ahead logs alone.
    std::uint64_t log_syncs() const;

    // For the file system's functions.
    struct Image;
    int open(const std::string& path, bool exists, std::shared_ptr<Image>& image);
    int write(Image& image, const void* data, int size, std::int64_t offset,
              const std::function<int()>& really);
    int truncate(Image& image, std::int64_t size, const std::function<int()>& really);
    int sync(Image& image);
    int remove(const std::string& path, bool synced, const std::function<int()>& really);
    int read(const std::function<int()>& really) const;

  private:
    struct Plan {
        Work work = Work::Write;
        Fault fault = Fault::Io;
        std::uint64_t after = 0;
        std::uint64_t times = 0;
    };
    int planned_fault(Work work);
    void put_down(const std::string& path, Image& image, std::optional<std::uint64_t> seed) const;

    const std::string name_;
    struct System;
    std::unique_ptr<System> system_;
    mutable std::mutex mutex_;
    std::map<std::string, std::shared_ptr<Image>> images_;
    Plan plan_;
    bool is_cut_ = false;
    std::uint64_t syncs_to_cut_ = 0;  ///< 0: none
    std::uint64_t failures_ = 0;
    std::uint64_t syncs_ = 0;
    std::uint64_t log_syncs_ = 0;
};

}  // namespace tinsmith::store_tests
