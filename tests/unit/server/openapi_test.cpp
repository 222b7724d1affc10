// SPDX-License-Identifier: Apache-2.0
// /openapi.json against the tables that the program works by: each difference is named, in both
// directions. What the routes answer is held against it in all tests of routes (handlers.hpp).
#include <set>

#include "api/problem.hpp"
#include "api/requests.hpp"
#include "server/cors.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

using Names = std::set<std::string>;
using Json = Description::json;

/// "missing: a b; too many: c", or nothing.
std::string differences(const Names& wanted, const Names& described) {
    std::string missing, more;
    for (const std::string& name : wanted)
        if (!described.contains(name)) missing += "\n  missing in api/openapi: " + name;
    for (const std::string& name : described)
        if (!wanted.contains(name)) more += "\n  only in api/openapi: " + name;
    return missing + more;
}

std::string lower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string upper(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

const Json& document() {
    return Description::get().document();
}

/// Calls `what` with the method, the path and the operation of each.
template <typename What>
void for_each_operation(What what) {
    for (const auto& [path, item] : document()["paths"].items()) {
        for (const auto& [method, operation] : item.items())
            what(upper(method), path, operation);
    }
}

template <typename Range>
Names names_of(const Range& range) {
    return Names(range.begin(), range.end());
}

class OpenApi : public Handlers {
  protected:
    /// A request of that operation about a session of its own, by the first example of its body.
    Response probe(const std::string& method, const std::string& path, const Json& operation,
                   NameValue header) {
        const std::string session = make_session();
        EXPECT_EQ(post(session + "/polygons", kParcel).status, 200);
        std::string target = path;
        const auto fill = [&target](const std::string& name, const std::string& value) {
            const std::size_t at = target.find(name);
            if (at != target.npos) target.replace(at, name.size(), value);
        };
        const bool is_made = method == "PUT" && path == "/v1/sessions/{id}";
        fill("/v1/sessions/{id}", is_made ? "/v1/sessions/probe" : session);
        fill("{pid}", "p1");
        fill("{version}", "2");
        fill("{file}", "page.css");
        if (path.ends_with("/elevation") && method == "GET") target += "?x=4&y=3";
        std::vector<NameValue> headers{std::move(header)};
        std::string body;
        if (operation.contains("requestBody")) {
            const Json& content = Description::get().resolved(operation["requestBody"])["content"];
            headers.emplace_back("content-type", content.begin().key());
            body = content.begin().value()["examples"].begin().value()["value"].dump();
        }
        Response response = ask(method, target, std::move(headers), body);
        for (const std::string& made :
             {std::string("/v1/sessions/probe"), session, Handlers::header(response, "Location")}) {
            if (!made.empty()) ask("DELETE", made);
        }
        return response;
    }
};

TEST_F(OpenApi, IsServedAsItIs) {
    const Response response = ask("GET", "/openapi.json");
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.content_type, "application/json");
    EXPECT_EQ(response.body, api::openapi_document());
    const std::string tag = header(response, "ETag");
    EXPECT_EQ(ask("GET", "/openapi.json", {{"if-none-match", tag}}).status, 304);
    EXPECT_EQ(document()["openapi"].get<std::string>().substr(0, 4), "3.1.");
    EXPECT_EQ(response.body.find("x-problems"), std::string::npos);
}

TEST_F(OpenApi, HasExactlyTheRoutes) {
    Names wanted, described;
    for (const Route& route : make_routes(services))
        wanted.insert(route.method + " " + route.pattern);
    for_each_operation([&](const std::string& method, const std::string& path, const Json&) {
        described.insert(method + " " + path);
    });
    EXPECT_EQ(differences(wanted, described), "");
}

TEST_F(OpenApi, HasExactlyTheParameters) {
    Names wanted, described;
    for (const Route& route : make_routes(services)) {
        for (const std::string_view name : route.parameters)
            wanted.insert(route.method + " " + route.pattern + "?" + std::string(name));
    }
    for_each_operation([&](const std::string& method, const std::string& path, const Json& what) {
        for (const std::string& name : Description::get().parameters(what, "query"))
            described.insert(method + " " + path + "?" + name);
        std::string pattern = path;
        for (const std::string& name : Description::get().parameters(what, "path")) {
            const std::size_t at = pattern.find("{" + name + "}");
            ASSERT_NE(at, pattern.npos) << path << " has no {" << name << "}";
            pattern.erase(at, name.size() + 2);
        }
        EXPECT_EQ(pattern.find('{'), pattern.npos) << path;
    });
    EXPECT_EQ(differences(wanted, described), "");
}

TEST_F(OpenApi, HasExactlyTheHeadersThatAreRead) {
    Names described;
    for_each_operation([&](const std::string&, const std::string&, const Json& operation) {
        for (const std::string& name : Description::get().parameters(operation, "header"))
            described.insert(lower(name));
    });
    Names wanted = names_of(understood_headers());
    // OpenAPI says these by media types and security schemes.
    for (const char* name : {"accept", "content-type", "authorization"})
        wanted.erase(name);
    // Passed on by pages' libraries, and not read.
    wanted.erase("tracestate");
    EXPECT_EQ(differences(wanted, described), "");
}

TEST_F(OpenApi, SaysWhereEachHeaderIsRead) {
    struct Broken {
        std::string name;
        std::string value;
    };
    for (const auto& [name, value] : std::vector<Broken>{
             {"If-Match", "bare"}, {"If-None-Match", "bare"}, {"Idempotency-Key", "with space"}}) {
        Names wanted, described;
        for_each_operation([&, &header = name, &broken = value](const std::string& method,
                                                                const std::string& path,
                                                                const Json& operation) {
            const std::string title = method + " " + path + " " + header;
            const Response response = probe(method, path, operation, {lower(header), broken});
            const bool is_read = response.status == 400 &&
                                 lower(response.body).find(lower(header)) != std::string::npos;
            if (is_read) wanted.insert(title);
            const auto names = Description::get().parameters(operation, "header");
            if (std::find(names.begin(), names.end(), header) != names.end())
                described.insert(title);
        });
        EXPECT_EQ(differences(wanted, described), "");
    }
}

TEST_F(OpenApi, HasExactlyTheHeadersThatPagesMayRead) {
    Names described;
    for_each_operation([&](const std::string&, const std::string&, const Json& operation) {
        for (const Json& answer : operation["responses"]) {
            for (const auto& [name, header] : answer["headers"].items())
                described.insert(name);
        }
    });
    Names wanted;
    std::istringstream list{std::string(exposed_headers())};
    for (std::string name; std::getline(list >> std::ws, name, ',');)
        wanted.insert(name);
    // Browsers give these to pages anyway, or act on them by themselves.
    for (const char* name : {"Vary", "Content-Encoding", "Content-Security-Policy", "Cache-Control",
                             "X-Content-Type-Options"})
        described.erase(name);
    EXPECT_EQ(differences(wanted, described), "");
}

TEST_F(OpenApi, HasExactlyTheLimits) {
    const auto told = json::parse(ask("GET", "/v1/limits").body);
    Names wanted, described;
    for (const auto& [name, value] : told.items())
        wanted.insert(name);
    const Json& schema = document()["components"]["schemas"]["Limits"];
    for (const auto& [name, value] : schema["properties"].items())
        described.insert(name);
    described.erase("key");  // of the key that asks: see KeyRoutes.AreToldTheirOwnLimits
    EXPECT_EQ(differences(wanted, described), "");
    EXPECT_EQ(names_of(schema["required"]), wanted);
}

TEST_F(OpenApi, HasExactlyTheProblems) {
    Names wanted, listed, used;
    for (const api::ProblemType type : api::all_problems())
        wanted.insert("urn:tinsmith:problem:" + std::string(api::problem_word(type)));
    for (const Json& type : document()["components"]["schemas"]["ProblemType"]["oneOf"])
        listed.insert(type["const"].get<std::string>());
    EXPECT_EQ(differences(wanted, listed), "");
    for_each_operation([&](const std::string&, const std::string&, const Json& operation) {
        for (const auto& [status, answer] : operation["responses"].items()) {
            const Json::json_pointer types(
                "/content/application~1problem+json/schema/properties/type/enum");
            if (!answer.contains(types)) continue;
            for (const Json& type : answer[types])
                used.insert(type.get<std::string>());
        }
    });
    used.insert("urn:tinsmith:problem:method-not-allowed");  // no operation's own
    EXPECT_EQ(differences(wanted, used), "");
}

TEST_F(OpenApi, NamesEachOperationOnce) {
    Names ids;
    for_each_operation([&](const std::string& method, const std::string& path, const Json& what) {
        EXPECT_TRUE(ids.insert(what["operationId"].get<std::string>()).second)
            << method << " " << path;
        EXPECT_FALSE(what["summary"].get<std::string>().empty());
    });
}

TEST_F(OpenApi, IsShownByAPageThatLoadsNothingFromElsewhere) {
    const Response page = ask("GET", "/docs");
    EXPECT_EQ(page.status, 200);
    EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
    EXPECT_EQ(header(page, "Content-Security-Policy").substr(0, 18), "default-src 'none'");
    EXPECT_EQ(ask("GET", "/docs", {{"if-none-match", header(page, "ETag")}}).status, 304);
    const Response script = ask("GET", "/docs/page.mjs");
    EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
    const Response style = ask("GET", "/docs/page.css");
    EXPECT_EQ(style.content_type, "text/css; charset=utf-8");
    for (const Response& part : {page, script, style}) {
        EXPECT_EQ(part.body.find("https://"), std::string::npos);
        EXPECT_EQ(part.body.find("//cdn"), std::string::npos);
    }
    EXPECT_EQ(ask("GET", "/docs/page.html").status, 404);
    EXPECT_EQ(ask("GET", "/docs/none").status, 404);
}

}  // namespace
}  // namespace tinsmith::server
