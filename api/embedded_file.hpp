// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace tinsmith {

/// A text file that is part of the program; api/embed.cmake puts it there.
struct EmbeddedFile {
    std::string_view name;  ///< without its folder
    std::string_view content;
};

std::span<const EmbeddedFile> openapi_files();  ///< api/openapi, by name
std::span<const EmbeddedFile> docs_files();     ///< server/docs

}  // namespace tinsmith
