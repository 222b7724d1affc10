// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// The whole file; nothing, with the reason in `error`, where it cannot be read.
std::optional<std::string> read_file(const std::string& path, std::string& error);

/// Writes beside the file and renames: readers see the old content or the new one, never a part.
/// Returns the reason where it failed, else an empty text.
std::string write_file_atomically(const std::string& path, std::string_view content);

}  // namespace tinsmith::server
