// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/keys/asker.hpp"

namespace tinsmith::server {

/// What the server knows of an API key: never the key itself.
///
/// A key is "tin_" and 256 bits from the system's generator, in hexadecimal. One SHA-256 of that
/// text is kept. A slow, salted hash would add nothing: it makes up for secrets that people choose,
/// which can be guessed, while nobody goes through 2^256 keys, nor prepares a table of them; and it
/// would cost every request its time.
struct ApiKey {
    std::string name;
    std::string id;    ///< random; belongs to what the key makes, and stays when it is renewed
    std::string hash;  ///< 32 bytes
    std::string made;  ///< "2026-11-26T13:00:00Z"
    KeyQuotas quotas;

    friend bool operator==(const ApiKey&, const ApiKey&) = default;
};

/// A new key in full. Throws std::runtime_error where the system has no random bytes.
std::string new_key();
std::string new_key_id();
/// The time now, as `ApiKey::made` has it.
std::string time_of_making();

std::string hash_of_key(std::string_view key);

/// What may stand in a log and in a file as it is: 1 to 64 letters, digits, dots, dashes and
/// underscores, a letter or digit in front.
bool is_key_name(std::string_view text);

}  // namespace tinsmith::server
