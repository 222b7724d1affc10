// SPDX-License-Identifier: Apache-2.0
#include "server/answer_finish.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "api/content_coding.hpp"
#include "api/field_list.hpp"
#include "api/media_type.hpp"
#include "server/cors.hpp"
#include "server/entity_tag.hpp"
#include "server/gzip.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

/// A body that fits one packet with its head gains nothing.
constexpr std::size_t kWorthwhile = 1024;

bool is_read(const Request& request) {
    return request.method == "GET" || request.method == "HEAD";
}

bool has(const Response& response, std::string_view name) {
    return std::any_of(response.headers.begin(), response.headers.end(),
                       [name](const NameValue& header) { return header.first == name; });
}

bool is_compressible(const Response& response) {
    static constexpr std::array<std::string_view, 10> kTypes{
        kJson,      kGeoJson,          "application/problem+json", kGltf, kObj, kXml, "text/html",
        "text/css", "text/javascript", "application/wasm"};
    const std::string type = api::media_type_of(response.content_type);
    return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

}  // namespace

bool wants_gzip(const Request& request, const Response& response) {
    return response.body.size() > kWorthwhile && is_compressible(response) &&
           !has(response, "Content-Encoding") &&
           api::accepts_gzip(combined_field(request, "accept-encoding").value_or(""));
}

bool encode_as_gzip(const Request& request, Response& response) {
    auto coded = gzip(response.body);
    if (!coded) return false;
    response.body = *std::move(coded);
    response.with("Content-Encoding", "gzip");
    if (!is_read(request)) return true;  // the tag of an edit's answer is the session's
    for (auto& [name, value] : response.headers) {
        if (name == "ETag" && value.size() >= 2) value.insert(value.size() - 1, kGzipSuffix);
    }
    return true;
}

void add_vary(Response& response, std::string_view name) {
    for (auto& [key, value] : response.headers) {
        if (key != "Vary") continue;
        std::string_view rest = value;
        while (!rest.empty()) {
            if (api::take_part(rest, ',') == name) return;
        }
        value += ", " + std::string(name);
        return;
    }
    response.with("Vary", std::string(name));
}

void finish_answer(const Policy& policy, const Request& request, Response& response) {
    if (wants_gzip(request, response)) encode_as_gzip(request, response);
    const bool may_be_coded =
        is_compressible(response) || (is_read(request) && response.sent().empty());
    if (may_be_coded) add_vary(response, "Accept-Encoding");
    if (request.trace) response.with("traceparent", request.trace->text());
    allow_origin(policy, request, response);
}

}  // namespace tinsmith::server
