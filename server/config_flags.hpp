// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class Validator;
}

namespace tinsmith::server {

/// "max_body_bytes" as a flag, "--max-body-bytes".
std::string flag_of(std::string name);

/// The library reads -5 as 2^64 - 5 and lets not-a-number through every range: no limit at all.
CLI::Validator digit_first();

}  // namespace tinsmith::server
