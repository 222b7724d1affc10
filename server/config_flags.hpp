// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include <CLI/CLI.hpp>

namespace tinsmith::server {

/// "max_body_bytes" as a flag, "--max-body-bytes".
inline std::string flag_of(std::string name) {
    std::replace(name.begin(), name.end(), '_', '-');
    return "--" + name;
}

/// The library reads -5 as 2^64 - 5 and lets not-a-number through every range: no limit at all.
inline CLI::Validator digit_first() {
    return {[](std::string& text) {
                const bool is_digit = !text.empty() && text.front() >= '0' && text.front() <= '9';
                return is_digit ? std::string() : "\"" + text + "\" does not begin with a digit";
            },
            "", "digit_first"};
}

}  // namespace tinsmith::server
