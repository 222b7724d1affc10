// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tinsmith::arch {

/// One source file, by its path from the project's root: "core/mesh/tin.hpp".
struct Source {
    std::string path;
    std::string text;
};

/// One broken rule. `line` counts from 1; 0 means the file as a whole.
struct Violation {
    std::string path;
    std::size_t line{};
    std::string what;

    friend bool operator==(const Violation&, const Violation&) = default;
};

/// Every rule of the house that one file can break by itself: the direction of includes, what core
/// and headers may include, where each third-party library lives, names and length.
std::vector<Violation> check_file(const Source& source);

/// The rules about all files together: a library confined to one file is in one file.
std::vector<Violation> check_all(const std::vector<Source>& sources);

/// The text with comments and the inside of literals blanked out, line breaks kept.
std::string code_only(std::string_view text);

}  // namespace tinsmith::arch
