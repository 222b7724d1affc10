// SPDX-License-Identifier: Apache-2.0
#include "server/random_id.hpp"

#include <algorithm>
#include <random>

#include "server/hex.hpp"

namespace tinsmith::server {

std::string random_hex(std::size_t bytes) {
    // getrandom(2) or the processor's own generator. To open it asks the processor what it is,
    // which takes long in a virtual machine.
    thread_local std::random_device source;
    std::string out(bytes, '\0');
    for (char& byte : out)
        byte = static_cast<char>(source() & 0xffU);
    return hex_of(out);
}

std::string random_uuid() {
    std::string id = random_hex(16);
    id[12] = '4';                                            // version
    id[16] = "89ab"[static_cast<std::size_t>(id[16]) & 3U];  // variant
    for (const std::size_t at : {8U, 13U, 18U, 23U})
        id.insert(at, 1, '-');
    return id;
}

bool is_sane_id(std::string_view id) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '.' || c == '_' || c == '-';
    };
    return !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), is_plain);
}

}  // namespace tinsmith::server
