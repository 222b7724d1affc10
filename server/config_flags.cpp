// SPDX-License-Identifier: Apache-2.0
#include "server/config_flags.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace tinsmith::server {

std::string flag_of(std::string name) {
    std::replace(name.begin(), name.end(), '_', '-');
    return "--" + name;
}

CLI::Validator digit_first() {
    return {[](std::string& text) {
                const bool is_digit = !text.empty() && text.front() >= '0' && text.front() <= '9';
                return is_digit ? std::string() : "\"" + text + "\" does not begin with a digit";
            },
            "", "digit_first"};
}

}  // namespace tinsmith::server
