// SPDX-License-Identifier: Apache-2.0
#include "server/file_io.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include <unistd.h>

namespace tinsmith::server {

namespace {

std::string last_error(const std::string& what) {
    return what + ": " + (errno != 0 ? std::strerror(errno) : "failed");
}

std::string write_all(const std::string& path, std::string_view content) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.flush();
    return file ? std::string() : last_error(path);
}

}  // namespace

std::optional<std::string> read_file(const std::string& path, std::string& error) {
    errno = 0;
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) {
        error = path + ": is a directory";
        return std::nullopt;
    }
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    if (file && file.peek() != std::ifstream::traits_type::eof()) content << file.rdbuf();
    if (!file.is_open() || file.bad() || content.fail()) {
        error = last_error(path);
        return std::nullopt;
    }
    return std::move(content).str();
}

std::string write_file_atomically(const std::string& path, std::string_view content) {
    namespace fs = std::filesystem;
    std::error_code code;
    // Through links, so that the file they lead to is replaced and not the link.
    fs::path target = fs::canonical(path, code);
    if (code) target = path;
    // A device or a pipe is written into: renamed over, /dev/null would become a file.
    const fs::file_status status = fs::status(target, code);
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_all(path, content);

    const std::string temporary = target.string() + ".tmp." + std::to_string(::getpid());
    std::string error = write_all(temporary, content);
    if (error.empty() && std::rename(temporary.c_str(), target.c_str()) != 0) {
        error = last_error(path);
    }
    if (!error.empty()) std::remove(temporary.c_str());
    // The temporary name says nothing to the caller.
    if (error.starts_with(temporary)) error.replace(0, temporary.size(), path);
    return error;
}

}  // namespace tinsmith::server
