// SPDX-License-Identifier: Apache-2.0
// The interface described: /openapi.json for programs, /docs for people.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "api/embedded_file.hpp"
#include "api/openapi.hpp"
#include "server/digest.hpp"
#include "server/hex.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/preconditions.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kPage = "page.html";

/// The page has what this server sends and nothing else, and is shown in no other page.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr std::size_t kTagDigits = 32;

/// What is the same for as long as the program runs, under a tag of its content.
Response send(const Request& request, std::string_view type, std::string_view content) {
    const std::array<std::string_view, 1> parts{content};
    const std::string etag = '"' + hex_of(sha256_of(parts)).substr(0, kTagDigits) + '"';
    if (auto answer = answer_where_unmodified(request, etag)) return *std::move(answer);
    return ok(std::string(type), std::string(content)).with("ETag", etag);
}

/// Null: there is none of that name.
const EmbeddedFile* find_docs_file(std::string_view name) {
    const auto files = docs_files();
    const auto found = std::find_if(files.begin(), files.end(),
                                    [name](const EmbeddedFile& file) { return file.name == name; });
    return found == files.end() ? nullptr : &*found;
}

std::string_view type_of(std::string_view name) {
    if (name.ends_with(".css")) return "text/css; charset=utf-8";
    if (name.ends_with(".mjs")) return "text/javascript; charset=utf-8";
    return "text/html; charset=utf-8";
}

}  // namespace

Response get_description(Services&, const Request& request, const PathArguments&) {
    return send(request, api::kOpenApiMediaType, api::openapi_document());
}

Response get_docs(Services&, const Request& request, const PathArguments&) {
    Response response = send(request, type_of(kPage), find_docs_file(kPage)->content);
    if (response.content_type == type_of(kPage)) {
        response.with("Content-Security-Policy", kPolicy);
    }
    return response;
}

Response get_docs_file(Services&, const Request& request, const PathArguments& arguments) {
    const EmbeddedFile* const file = find_docs_file(arguments[0]);
    if (file == nullptr || file->name == kPage) {
        return refuse(request, api::ProblemType::NoSuchPath, "The page is at /docs.");
    }
    return send(request, type_of(file->name), file->content);
}

}  // namespace tinsmith::server
