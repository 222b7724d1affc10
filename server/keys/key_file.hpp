// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/keys/api_key.hpp"

namespace tinsmith::server {

// The file of keys: text, one key a line,
//
//     NAME ID SHA256 MADE [QUOTA=NUMBER ...]
//
// with blank lines and lines that begin with "#" passed over. The SHA-256 is of the key's text, in
// hexadecimal: what `printf %s KEY | sha256sum` says.

using Keys = std::vector<ApiKey>;

/// All that is wrong, a line of text for each, such as `/data/keys:3: the id "x" is ...`.
using KeyFaults = std::vector<std::string>;

/// At most 100 faults are told. `path` is what they call the file.
std::variant<Keys, KeyFaults> parse_keys(std::string_view text, const std::string& path);
std::string write_keys(const Keys& keys);

/// The keys of a file; none where there is no such file and it may be `missing`.
std::variant<Keys, KeyFaults> read_key_file(const std::string& path, bool missing);

/// Makes the file anew of what `change` makes of its keys; `change` returns why it does not, and
/// then all is as it was. A file that is not there is made. Others that change it the same way
/// wait. Whoever reads it, and whatever ends the process, finds all of the old keys or all of the
/// new ones; mode 0600. Faults: none, it is done and on the disk.
KeyFaults change_key_file(const std::string& path,
                          const std::function<std::optional<std::string>(Keys&)>& change);

/// Quotas by their names, as files and /v1/limits have them. Nothing: that one is not set.
struct NamedQuota {
    std::string_view name;
    std::optional<double> value;
};
std::vector<NamedQuota> named_quotas(const KeyQuotas& quotas);
std::string quota_text(double value);

}  // namespace tinsmith::server
