// SPDX-License-Identifier: Apache-2.0
#include "server/keys/private_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace tinsmith::server {

namespace {

constexpr mode_t kOwnerOnly = 0600;

std::string last_error(const std::string& path) {
    return path + ": " + std::strerror(errno);
}

bool write_all(int file, std::string_view content) {
    while (!content.empty()) {
        const ssize_t count = ::write(file, content.data(), content.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        content.remove_prefix(static_cast<std::size_t>(count));
    }
    return ::fsync(file) == 0;
}

/// A name is on the disk once its folder is.
bool sync_folder(const std::filesystem::path& file) {
    const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return false;
    const bool fine = ::fsync(handle) == 0;
    ::close(handle);
    return fine;
}

}  // namespace

std::string write_private_file(const std::string& path, std::string_view content) {
    namespace fs = std::filesystem;
    std::error_code code;
    fs::path target = fs::canonical(path, code);
    if (code) target = path;
    std::string temporary = target.string() + ".XXXXXX";
    const int file = ::mkostemp(temporary.data(), O_CLOEXEC);  // with mode 0600
    if (file < 0) return last_error(path);
    bool fine = write_all(file, content);
    std::string error = fine ? std::string() : last_error(path);
    ::close(file);
    if (fine) {
        fine = std::rename(temporary.c_str(), target.c_str()) == 0 && sync_folder(target);
        if (!fine) error = last_error(path);
    }
    if (!fine) std::remove(temporary.c_str());
    return error;
}

std::optional<FileTurn> FileTurn::take(const std::string& path, std::string& error) {
    const std::string lock = path + ".lock";
    const int file = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnerOnly);
    if (file < 0) {
        error = last_error(lock);
        return std::nullopt;
    }
    FileTurn turn(file);
    while (::flock(file, LOCK_EX) != 0) {
        if (errno == EINTR) continue;
        error = last_error(lock);
        return std::nullopt;
    }
    return turn;
}

FileTurn::FileTurn(FileTurn&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FileTurn::~FileTurn() {
    if (file_ >= 0) ::close(file_);
}

}  // namespace tinsmith::server
