// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::api {

/// One element of Accept or Accept-Encoding: "gzip;q=0.5".
struct Weighted {
    std::string name;     ///< lower-case, without parameters
    double weight = 1.0;  ///< 0: not acceptable
};

/// Without spaces and tabs at either end.
std::string_view trimmed(std::string_view text);

/// ASCII letters only.
std::string lower_case(std::string_view text);

/// Takes what stands before the separator off the front of `rest`, trimmed.
std::string_view take_part(std::string_view& rest, char separator);

/// Parameters other than "q" are passed over. Nothing where the name is empty or the weight is no
/// number from 0 to 1.
std::optional<Weighted> parse_weighted(std::string_view text);

}  // namespace tinsmith::api
