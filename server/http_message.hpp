// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/keys/asker.hpp"
#include "server/trace_context.hpp"

namespace tinsmith::server {

class RouteMeter;

using NameValue = std::pair<std::string, std::string>;

/// One HTTP request as handlers see it: plain data, no socket, no library type.
/// Header names are lower-case; the query keeps the client's order and is percent-decoded.
/// `path` stays as it was sent (still encoded), because only the router knows its segments.
struct Request {
    std::string method;
    std::string path;
    std::vector<NameValue> query;
    std::vector<NameValue> headers;
    std::string body;
    std::string remote_address;
    std::string id;                       ///< the request id that every answer carries
    std::optional<TraceContext> trace{};  ///< the sender's, with a span of our own as parent
    Asker asker{};                        ///< who asks: the gate says it, never the client
    std::shared_ptr<const void> pass{};   ///< held as long as the request counts as in flight

    /// The first header of that lower-case name.
    std::optional<std::string_view> header(std::string_view name) const {
        for (const auto& [key, value] : headers) {
            if (key == name) return value;
        }
        return std::nullopt;
    }

    /// The query parameter of that name; the router has refused repeated ones.
    std::optional<std::string_view> parameter(std::string_view name) const {
        for (const auto& [key, value] : query) {
            if (key == name) return value;
        }
        return std::nullopt;
    }
};

/// One HTTP answer. An empty body is sent with no content type.
struct Response {
    int status = 200;
    std::string content_type;
    std::vector<NameValue> headers;
    std::string body;
    bool close = false;  ///< end the connection: what follows on it cannot be trusted
    /// The pattern of the path that answered; null: none did. It lives as long as the router.
    const RouteMeter* route = nullptr;
    std::string_view problem = {};  ///< the stable word of a refusal, for the log; else empty
    /// Instead of `body`, where others have it too: a mesh of megabytes is not copied to be sent.
    std::shared_ptr<const std::string> shared_body{};

    /// The body, whoever has it.
    const std::string& sent() const { return shared_body ? *shared_body : body; }

    Response& with(std::string name, std::string value) {
        headers.emplace_back(std::move(name), std::move(value));
        return *this;
    }
};

}  // namespace tinsmith::server
