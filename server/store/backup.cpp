// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "server/store/journal.hpp"
#include "server/store/layout.hpp"

namespace tinsmith::server {

namespace fs = std::filesystem;

namespace {

std::string last_error(const fs::path& path) {
    return path.string() + ": " + std::strerror(errno);
}

/// With all that was written through other names and descriptors.
std::optional<std::string> sync(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return last_error(path);
    const bool done = ::fsync(file) == 0;
    auto why = done ? std::nullopt : std::optional(last_error(path));
    ::close(file);
    return why;
}

/// No lock is taken: readers of a write-ahead log see one commit and hold up none.
std::optional<std::string> copy_store(const fs::path& folder, const fs::path& to) {
    auto opened = store::open_database(folder, store::Database::Access::Read, {});
    if (auto* why = std::get_if<std::string>(&opened)) return std::move(*why);
    // It grows under another name and gets its own once it is whole.
    const fs::path target = store::database_file(to);
    const fs::path growing = to / "growing.db";
    auto fault = std::get<store::Database>(opened).copy_to(growing);
    auto why = fault ? std::optional(growing.string() + ": " + fault->text) : sync(growing);
    std::error_code code;
    if (!why) {
        fs::rename(growing, target, code);
        why = code ? std::optional(target.string() + ": " + code.message()) : sync(to);
    }
    if (!why) return std::nullopt;
    for (const char* ending : {"", "-journal", "-wal", "-shm"})
        fs::remove(growing.string() + ending, code);
    fs::remove(target, code);
    return why;
}

}  // namespace

std::optional<std::string> backup_store(const fs::path& folder, const fs::path& to) {
    std::error_code code;
    if (!fs::is_regular_file(store::database_file(folder), code))
        return folder.string() + " holds no store: there is no " +
               store::database_file(folder).string();
    // A folder that a server takes as it is. Empty, or made now: nothing is written over.
    const bool is_made = ::mkdir(to.c_str(), S_IRWXU) == 0;
    if (!is_made && errno != EEXIST) return last_error(to);
    if (!is_made && (!fs::is_directory(to, code) || !fs::is_empty(to, code)))
        return to.string() + " is there and is no empty folder: nothing is written over";
    auto why = copy_store(folder, to);
    if (!why && is_made) why = sync(fs::absolute(to / "..", code));
    if (why && is_made) fs::remove(to, code);
    return why;
}

}  // namespace tinsmith::server
