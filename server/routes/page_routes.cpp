// SPDX-License-Identifier: Apache-2.0
// The page of `/` and the files that it is made of. Their names change with their content.
#include "server/routes/page_routes.hpp"

#include <string>
#include <utility>

#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/preconditions.hpp"

namespace tinsmith::server {

namespace {

/// The page has what this server sends and nothing else, and is shown in no other page. Draco's
/// decoder is WebAssembly, in a worker that the page makes itself.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; "
    "connect-src 'self'; img-src 'self' data: blob:; style-src 'self'; frame-ancestors 'none'; "
    "base-uri 'none'; form-action 'none'";

/// What is served where the page was not built.
constexpr std::string_view kNoPage =
    "<!DOCTYPE html>\n"
    "<html lang=\"en\">\n"
    "<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<title>Tinsmith</title>\n"
    "<link rel=\"icon\" href=\"data:,\">\n"
    "<h1>Tinsmith</h1>\n"
    "<p>The service runs; its interface is described at <a href=\"docs\">/docs</a>.</p>\n"
    "<p>The page that shows terrains was not built with this program. It takes Node 18 or later.\n"
    "In the project's folder:</p>\n"
    "<pre>server/viewer/build.sh build/viewer\nbuild/release/tinsmith serve --viewer build/viewer"
    "</pre>\n"
    "</html>\n";

Response send(const Request& request, const PageFile& file, std::string caching) {
    auto unmodified = answer_where_unmodified(request, file.etag);
    Response response = unmodified
                            ? *std::move(unmodified)
                            : ok(std::string(file.type), file.content).with("ETag", file.etag);
    if (response.status != 200) return response;
    return response.with("Cache-Control", std::move(caching))
        .with("Content-Security-Policy", kPolicy)
        .with("X-Content-Type-Options", "nosniff");
}

Response get_page_file(Services& services, const Request& request, const PathArguments& arguments) {
    const PageFile* const file =
        arguments[0] == PageFiles::kIndex ? nullptr : services.page.find(arguments[0]);
    if (file == nullptr) {
        return refuse(request, api::ProblemType::NoSuchPath,
                      "The page at / has no such file: load it again.");
    }
    return send(request, *file, "public, max-age=31536000, immutable");
}

}  // namespace

Response get_page(Services& services, const Request& request, const PathArguments&) {
    static const PageFile kNone = make_page_file(PageFiles::kIndex, std::string(kNoPage));
    const PageFile* const page = services.page.find(PageFiles::kIndex);
    return send(request, page == nullptr ? kNone : *page, "no-cache");
}

std::vector<Route> make_page_routes(Services& services) {
    return {{"GET",
             std::string(kPageFolder) + "{file}",
             {},
             [&services](const Request& request, const PathArguments& arguments) {
                 return get_page_file(services, request, arguments);
             }}};
}

}  // namespace tinsmith::server
