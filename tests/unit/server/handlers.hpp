// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/answer_finish.hpp"
#include "server/router.hpp"
#include "server/routes/route_table.hpp"
#include "server/target.hpp"
#include "tests/unit/server/description.hpp"

namespace tinsmith::server {

using nlohmann::json;

inline constexpr const char* kSquare =
    R"({"name": "Square", "crs": "EPSG:32616", "mesh": {
        "vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]], "triangles": [[0,1,2],[0,2,3]]}})";
inline constexpr const char* kParcel =
    R"({"type": "Polygon", "coordinates": [[[2,2],[5,2],[5,5],[2,5],[2,2]]]})";

/// Stands in front of the routes: says who asks, or answers instead.
using Admit = std::function<std::optional<Response>(Request&)>;

/// What a client is answered, without a socket; each answer is held against /openapi.json.
inline Response ask(const Router& router, const Services& services, const std::string& method,
                    const std::string& target, std::vector<NameValue> headers = {},
                    const std::string& body = {}, const Admit& admit = {}) {
    auto parsed = parse_target(target).value();
    Request request;
    request.method = method;
    request.path = parsed.path;
    request.query = std::move(parsed.query);
    request.headers = std::move(headers);
    request.body = body;
    request.id = "test";
    request.trace = parse_traceparent(request.header("traceparent").value_or(""));
    auto refusal = admit ? admit(request) : std::nullopt;
    Response response = refusal ? *std::move(refusal) : router.handle(request);
    finish_answer(services.policy, request, response);
    if (response.shared_body) response.body = *response.shared_body;
    EXPECT_EQ(Description::get().complaint(request, response), "")
        << method << " " << target << " is answered as /openapi.json does not say";
    return response;
}

/// The routes as a client meets them.
class Handlers : public ::testing::Test {
  protected:
    static Limits few_sessions() {
        Limits limits;
        limits.max_sessions = 3;
        limits.max_vertices = 1000;
        return limits;
    }

    Response ask(const std::string& method, const std::string& target,
                 std::vector<NameValue> headers = {}, const std::string& body = {}) {
        return server::ask(router, services, method, target, std::move(headers), body, admit);
    }

    Response post(const std::string& target, const std::string& body,
                  std::vector<NameValue> headers = {}) {
        headers.emplace_back("content-type", "application/json");
        return ask("POST", target, std::move(headers), body);
    }

    std::string make_session() {
        const Response made = post("/v1/sessions", kSquare);
        EXPECT_EQ(made.status, 201) << made.body;
        return "/v1/sessions/" + json::parse(made.body)["id"].get<std::string>();
    }

    /// The codes in errors[], or the problem's word where there are none.
    static std::string told(const Response& response) {
        const auto body = json::parse(response.body, nullptr, false);
        if (!body.is_object() || response.content_type != "application/problem+json") return "?";
        if (!body.contains("errors")) return body["type"].get<std::string>().substr(21);
        std::string codes;
        for (const auto& error : body["errors"]) {
            codes += (codes.empty() ? "" : " ") + error["code"].get<std::string>();
        }
        return codes;
    }

    static std::string header(const Response& response, const std::string& name) {
        for (const auto& [key, value] : response.headers) {
            if (key == name) return value;
        }
        return "";
    }

    int version_of(const std::string& session) {
        return json::parse(ask("GET", session).body)["version"].get<int>();
    }

    /// What stands in front of the routes, if anything does.
    Admit admit;
    Services services{few_sessions()};
    Router router{make_routes(services)};
};

}  // namespace tinsmith::server
