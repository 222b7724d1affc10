// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "api/openapi.hpp"
#include "server/http_message.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

/// /openapi.json as what answers are held against. Whatever a test asks of the routes is checked by
/// it: the status, the media type, the problem and the headers have to be in the description.
class Description {
  public:
    using json = nlohmann::ordered_json;

    static const Description& get() {
        static const Description description;
        return description;
    }

    const json& document() const { return document_; }

    /// What a "$ref" means, or the value itself.
    const json& resolved(const json& value) const {
        if (!value.contains("$ref")) return value;
        return document_.at(json::json_pointer(value["$ref"].get<std::string>().substr(1)));
    }

    /// The parameters of an operation that are in "query", "header" or "path".
    std::vector<std::string> parameters(const json& operation, const std::string& in) const {
        std::vector<std::string> names;
        for (const json& one : operation["parameters"]) {
            const json& parameter = resolved(one);
            if (parameter["in"] == in) names.push_back(parameter["name"].get<std::string>());
        }
        return names;
    }

    /// What of an answer is not described; empty: nothing, or it is that of no operation.
    std::string complaint(const Request& request, const Response& response) const {
        const json* const operation = find(request);
        if (operation == nullptr) return {};
        const std::string status = std::to_string(response.status);
        const json& answers = (*operation)["responses"];
        // The answers of other requests: what a job has to give.
        if (answers.contains("default")) return {};
        if (!answers.contains(status)) return "status " + status;
        const json& answer = answers[status];
        std::string said = about_body(answer, response);
        for (const auto& [name, value] : response.headers) {
            if (!has_header(answer, name)) said += " header " + name;
        }
        return said;
    }

  private:
    Description() : document_(json::parse(api::openapi_document())) {}

    const json* find(const Request& request) const {
        const auto path = split_path(request.path);
        std::string method = request.method == "HEAD" ? "GET" : request.method;
        std::transform(method.begin(), method.end(), method.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        for (const auto& [pattern, item] : document_["paths"].items()) {
            const auto wanted = split_path(pattern);
            const bool is_it =
                path && std::equal(wanted->begin(), wanted->end(), path->begin(), path->end(),
                                   [](const std::string& want, const std::string& have) {
                                       return want.starts_with('{') ? !have.empty() : want == have;
                                   });
            if (is_it && item.contains(method)) return &item[method];
        }
        return nullptr;
    }

    static std::string about_body(const json& answer, const Response& response) {
        if (response.body.empty()) return {};
        if (!answer.contains("content") || !answer["content"].contains(response.content_type)) {
            return "media type " + response.content_type;
        }
        if (response.content_type != "application/problem+json") return {};
        const json& types =
            answer["content"][response.content_type]["schema"]["properties"]["type"]["enum"];
        const json problem = json::parse(response.body);
        const bool is_listed =
            std::find(types.begin(), types.end(), problem["type"]) != types.end();
        return is_listed ? "" : "problem " + problem["type"].get<std::string>();
    }

    static bool has_header(const json& answer, const std::string& name) {
        // Of the path and of the page that asks, not of the operation.
        if (name == "Allow" || name.starts_with("Access-Control-")) return true;
        return answer.contains("headers") && answer["headers"].contains(name);
    }

    json document_;
};

}  // namespace tinsmith::server
