// SPDX-License-Identifier: Apache-2.0
#include "server/keys/api_key.hpp"

#include <array>
#include <ctime>
#include <stdexcept>

#include <unistd.h>

#include "server/digest.hpp"
#include "server/hex.hpp"
#include "server/random_id.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kPrefix = "tin_";
constexpr std::size_t kKeyBytes = 32;
constexpr std::size_t kIdBytes = 8;

/// From the kernel and from nowhere else.
template <std::size_t kCount>
std::string random_digits() {
    std::array<char, kCount> bytes{};
    if (::getentropy(bytes.data(), bytes.size()) != 0)
        throw std::runtime_error("the system has no random bytes");
    return hex_of({bytes.data(), bytes.size()});
}

}  // namespace

std::string new_key() {
    return std::string(kPrefix) + random_digits<kKeyBytes>();
}

std::string new_key_id() {
    return random_digits<kIdBytes>();
}

std::string time_of_making() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text.data(), size};
}

std::string hash_of_key(std::string_view key) {
    return plain_sha256_of(key);
}

bool is_key_name(std::string_view text) {
    const auto is_mark = [](char c) { return c == '.' || c == '-' || c == '_'; };
    return is_sane_id(text) && !is_mark(text.front());
}

}  // namespace tinsmith::server
