// SPDX-License-Identifier: Apache-2.0
#include "server/page_files.hpp"

#include <array>
#include <filesystem>
#include <utility>

#include "server/digest.hpp"
#include "server/file_io.hpp"
#include "server/hex.hpp"

namespace tinsmith::server {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTagDigits = 32;

std::string_view type_of(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kTypes{{
        {".html", "text/html; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".wasm", "application/wasm"},
        {".svg", "image/svg+xml"},
        {".txt", "text/plain; charset=utf-8"},
    }};
    for (const auto& [ending, type] : kTypes)
        if (name.ends_with(ending)) return type;
    return "application/octet-stream";
}

}  // namespace

PageFile make_page_file(std::string_view name, std::string content) {
    const std::array<std::string_view, 1> parts{content};
    std::string etag = '"' + hex_of(sha256_of(parts)).substr(0, kTagDigits) + '"';
    return {type_of(name), std::move(content), std::move(etag)};
}

PageFiles PageFiles::read(const std::string& folder, std::string& error) {
    PageFiles page;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder, failed)) {
        if (!entry.is_regular_file(failed)) continue;
        std::string name = entry.path().filename().string();
        auto content = read_file(entry.path().string(), error);
        if (!content) return {};
        PageFile file = make_page_file(name, *std::move(content));
        page.files_.emplace(std::move(name), std::move(file));
    }
    if (failed) {
        error = folder + ": " + failed.message();
        return {};
    }
    if (page.is_there()) return page;
    error = folder + ": no index.html is there; server/viewer says how the page is built";
    return {};
}

const PageFile* PageFiles::find(std::string_view name) const {
    const auto found = files_.find(name);
    return found == files_.end() ? nullptr : &found->second;
}

std::string bundled_page() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error) return {};
    const fs::path above = program.parent_path().parent_path();
    for (const fs::path& folder : {above / "share" / "tinsmith" / "viewer", above / "viewer"})
        if (fs::exists(folder / PageFiles::kIndex, error)) return folder.string();
    return {};
}

}  // namespace tinsmith::server
