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
    const std::string temporary = path + ".tmp." + std::to_string(::getpid());
    errno = 0;
    {
        std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
        file.write(content.data(), static_cast<std::streamsize>(content.size()));
        file.flush();
        if (!file) {
            const std::string error = last_error(path);
            std::remove(temporary.c_str());
            return error;
        }
    }
    if (std::rename(temporary.c_str(), path.c_str()) != 0) {
        const std::string error = last_error(path);
        std::remove(temporary.c_str());
        return error;
    }
    return {};
}

}  // namespace tinsmith::server
