// SPDX-License-Identifier: Apache-2.0
#include "server/routes/page_routes.hpp"

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

namespace fs = std::filesystem;

class PageRoutes : public Handlers {
  protected:
    PageRoutes() {
        fs::create_directories(folder);
        std::ofstream(folder / "index.html") << "<!DOCTYPE html><title>The page</title>";
        std::ofstream(folder / "main-0123.js") << std::string(5000, ';');
    }
    ~PageRoutes() override { fs::remove_all(folder); }

    void build_page() {
        std::string error;
        services.page = PageFiles::read(folder.string(), error);
        ASSERT_EQ(error, "");
    }

    /// Of the page's own files.
    Response file(const std::string& method, const std::string& path,
                  std::vector<NameValue> headers = {}) {
        Request request;
        request.method = method;
        request.path = path;
        request.headers = std::move(headers);
        Response response = Router(make_page_routes(services)).handle(request);
        finish_answer(services.policy, request, response);
        return response;
    }

    const fs::path folder =
        fs::temp_directory_path() / ("tinsmith-page-routes-" + std::to_string(getpid()));
};

TEST_F(PageRoutes, SayHowThePageIsBuiltWhereItIsNot) {
    const Response page = ask("GET", "/");
    EXPECT_EQ(page.status, 200);
    EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
    EXPECT_NE(page.body.find("href=\"docs\""), std::string::npos);
    EXPECT_NE(page.body.find("server/viewer/build.sh"), std::string::npos);
    EXPECT_EQ(file("GET", "/viewer/main-0123.js").status, 404);
}

TEST_F(PageRoutes, SendThePageUnderItsPolicy) {
    build_page();
    const Response page = ask("GET", "/");
    EXPECT_EQ(page.body, "<!DOCTYPE html><title>The page</title>");
    EXPECT_EQ(header(page, "Cache-Control"), "no-cache");
    const std::string policy = header(page, "Content-Security-Policy");
    EXPECT_EQ(policy.substr(0, 18), "default-src 'none'");
    for (const char* hole : {"unsafe-inline", "'unsafe-eval'", "*", "http"})
        EXPECT_EQ(policy.find(hole), std::string::npos) << hole;
    EXPECT_EQ(ask("GET", "/", {{"if-none-match", header(page, "ETag")}}).status, 304);
    EXPECT_EQ(ask("GET", "/?a=b").status, 400);
}

TEST_F(PageRoutes, SendItsFilesForGood) {
    build_page();
    const Response script = file("GET", "/viewer/main-0123.js", {{"accept-encoding", "gzip"}});
    EXPECT_EQ(script.status, 200);
    EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
    EXPECT_EQ(header(script, "Content-Encoding"), "gzip");
    EXPECT_EQ(header(script, "Cache-Control"), "public, max-age=31536000, immutable");
    EXPECT_EQ(header(script, "X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(header(script, "Content-Security-Policy").substr(0, 18), "default-src 'none'");
    const Response again =
        file("GET", "/viewer/main-0123.js",
             {{"accept-encoding", "gzip"}, {"if-none-match", header(script, "ETag")}});
    EXPECT_EQ(again.status, 304);
    EXPECT_EQ(again.body, "");
    EXPECT_EQ(file("POST", "/viewer/main-0123.js").status, 405);
    for (const char* path : {"/viewer/none.js", "/viewer/index.html", "/viewer/",
                             "/viewer/..%2findex.html", "/viewer/a/main-0123.js"}) {
        EXPECT_EQ(file("GET", path).status, 404) << path;
    }
}

}  // namespace
}  // namespace tinsmith::server
