// SPDX-License-Identifier: Apache-2.0
#include "server/store/folder_lock.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tinsmith::server::store {

namespace {

std::string last_error(const std::filesystem::path& path) {
    return path.string() + ": " + std::strerror(errno);
}

/// So that the name of what was just made in it outlives the power.
void sync_folder(const std::filesystem::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;
    ::fsync(file);
    ::close(file);
}

std::optional<std::string> make_folder(const std::filesystem::path& folder) {
    std::error_code code;
    const std::filesystem::path whole = std::filesystem::absolute(folder, code).lexically_normal();
    std::filesystem::path path = whole;
    if (!path.has_filename()) path = path.parent_path();  // "data/"
    if (!code) std::filesystem::create_directories(path.parent_path(), code);
    if (code) return folder.string() + ": " + code.message();
    if (::mkdir(path.c_str(), S_IRWXU) == 0) {
        sync_folder(path.parent_path());
        return std::nullopt;
    }
    if (errno != EEXIST) return last_error(folder);
    if (!std::filesystem::is_directory(path, code)) return folder.string() + " is no folder";
    return std::nullopt;
}

/// What the one who holds the lock has written into it.
std::string holder(int file) {
    std::array<char, 16> text{};
    const auto size = ::pread(file, text.data(), text.size(), 0);
    std::string pid(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    pid.erase(
        std::find_if(pid.begin(), pid.end(), [](unsigned char c) { return !std::isdigit(c); }),
        pid.end());
    return pid.empty() ? std::string() : " (process " + pid + ")";
}

}  // namespace

std::variant<FolderLock, std::string> FolderLock::take(const std::filesystem::path& folder) {
    if (const auto why = make_folder(folder)) return *why;
    const std::filesystem::path path = folder / "lock";
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file < 0) return last_error(path);
    FolderLock lock(file);
    if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK) return last_error(path);
        return folder.string() + " is in use by another server" + holder(file) +
               "; stop that one, or give another folder";
    }
    // For the words above alone: on a full disk it stays empty.
    const std::string pid = std::to_string(::getpid());
    if (::ftruncate(file, 0) == 0) {
        [[maybe_unused]] const auto written = ::pwrite(file, pid.data(), pid.size(), 0);
    }
    return lock;
}

FolderLock::~FolderLock() {
    if (file_ >= 0) ::close(file_);
}

}  // namespace tinsmith::server::store
