// SPDX-License-Identifier: Apache-2.0
#include "server/page_files.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace tinsmith::server {
namespace {

namespace fs = std::filesystem;

class Page : public testing::Test {
  protected:
    Page() { fs::create_directories(folder / "below"); }
    ~Page() override { fs::remove_all(folder); }

    void put(const std::string& name, const std::string& content) const {
        std::ofstream(folder / name, std::ios::binary) << content;
    }

    const fs::path folder =
        fs::temp_directory_path() / ("tinsmith-page-" + std::to_string(getpid()));
    std::string error;
};

TEST_F(Page, IsReadWholeWithTypesAndTags) {
    put("index.html", "<!DOCTYPE html>");
    put("main-0123.js", "let a;");
    put("page-0123.css", "a {}");
    put("draco-0123.wasm", std::string("\0asm", 4));
    put("below/hidden.js", "let b;");
    const PageFiles page = PageFiles::read(folder.string(), error);
    EXPECT_EQ(error, "");
    ASSERT_TRUE(page.is_there());
    EXPECT_EQ(page.find("index.html")->type, "text/html; charset=utf-8");
    EXPECT_EQ(page.find("main-0123.js")->type, "text/javascript; charset=utf-8");
    EXPECT_EQ(page.find("page-0123.css")->type, "text/css; charset=utf-8");
    EXPECT_EQ(page.find("draco-0123.wasm")->type, "application/wasm");
    EXPECT_EQ(page.find("draco-0123.wasm")->content.size(), 4U);
    EXPECT_EQ(page.find("main-0123.js")->etag.size(), 34U);
    EXPECT_NE(page.find("main-0123.js")->etag, page.find("page-0123.css")->etag);
    for (const char* name : {"", "none.js", "hidden.js", "below", "below/hidden.js",
                             "../page-0123.css", "./index.html"}) {
        EXPECT_EQ(page.find(name), nullptr) << name;
    }
}

TEST_F(Page, SaysWhyThereIsNone) {
    EXPECT_FALSE(PageFiles::read(folder.string(), error).is_there());
    EXPECT_NE(error.find("no index.html"), std::string::npos) << error;
    EXPECT_FALSE(PageFiles::read((folder / "none").string(), error).is_there());
    EXPECT_NE(error.find("none"), std::string::npos) << error;
    EXPECT_FALSE(PageFiles().is_there());
}

}  // namespace
}  // namespace tinsmith::server
