// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tinsmith::server {

/// One file of the built page, as it is sent.
struct PageFile {
    std::string_view type;
    std::string content;
    std::string etag;
};

/// With the type that the name's ending says, under a tag of its content.
PageFile make_page_file(std::string_view name, std::string content);

/// The page of `/`, built by server/viewer: read once, whole, from one folder without its
/// subfolders. What is asked for is looked up by name among what was read then, so that no path of
/// a request ever reaches the file system.
class PageFiles {
  public:
    static constexpr std::string_view kIndex = "index.html";

    /// No page: the program can be built and run without.
    PageFiles() = default;

    /// The files of a folder that has an index.html; with the reason in `error` where that fails,
    /// and then without any file.
    static PageFiles read(const std::string& folder, std::string& error);

    /// Null: there is none of that name.
    const PageFile* find(std::string_view name) const;
    bool is_there() const { return find(kIndex) != nullptr; }

  private:
    std::map<std::string, PageFile, std::less<>> files_;
};

/// The folder of the built page: installed beside the program, or in the build tree it stands in.
/// Empty: neither is there.
std::string bundled_page();

}  // namespace tinsmith::server
