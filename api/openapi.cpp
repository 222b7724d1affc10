// SPDX-License-Identifier: Apache-2.0
#include "api/openapi.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "api/embedded_file.hpp"
#include "api/problem.hpp"

namespace tinsmith::api {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kProblems = "x-problems";
/// Of an operation that hands on what others answered: any refusal of a status that it has itself.
constexpr const char* kRelays = "x-relays";
constexpr const char* kAnswers = "x-answers";
constexpr const char* kAnswerHeaders = "x-answer-headers";
constexpr const char* kRecorded = "x-recorded";
constexpr const char* kQuery = "x-query";
/// The security scheme of what wants an API key.
constexpr const char* kApiKey = "ApiKey";
/// The names of those options of a mesh that an edit's answer takes too.
constexpr const char* kMeshQuery = "x-mesh-query";

/// Of each operation, whatever it is; by their names under components.
constexpr std::array<const char*, 3> kRequestHeaders{"AcceptEncoding", "RequestId", "TraceParent"};
const std::array<std::pair<const char*, const char*>, 4> kGeneralHeaders{{
    {"X-Request-Id", "RequestId"},
    {"traceparent", "TraceParent"},
    {"Vary", "Vary"},
    {"Content-Encoding", "ContentEncoding"},
}};

std::string type_of(std::string_view word) {
    return "urn:tinsmith:problem:" + std::string(word);
}

Json reference(const std::string& to) {
    return {{"$ref", "#/components/" + to}};
}

/// Where a server that has API keys wants one (server/keys/gate.hpp).
bool wants_key(std::string_view path) {
    return path.starts_with("/v1/") || path == "/metrics";
}

/// All parts, one over the other: objects of the same place become one.
Json joined_parts() {
    Json document = Json::object();
    for (const EmbeddedFile& file : openapi_files())
        document.update(Json::parse(file.content), true);
    return document;
}

/// One operation of the document on its way from what the files say to what is served.
class Operation {
  public:
    Operation(const Json& document, std::string_view path, const std::string& method,
              Json& operation)
        : document_(document), operation_(operation) {
        add_words(document_[kProblems]["any"]);
        if (wants_key(path)) {
            add_words(document_[kProblems]["with_key"]);
            // Or none, where the operator has made none.
            operation_["security"] = {{{kApiKey, Json::array()}}, Json::object()};
        }
        if (method != "get") add_words(document_[kProblems]["with_body"]);
    }

    void complete() {
        add_query();
        for (const Json& parameter : operation_["parameters"]) {
            const Json& named = resolved(parameter);
            add_words_of(named);
            if (named.contains(kAnswerHeaders)) answer_headers_.update(named[kAnswerHeaders]);
            if (named.contains(kAnswers)) operation_["responses"].update(named[kAnswers]);
        }
        if (operation_.contains("requestBody")) add_words_of(resolved(operation_["requestBody"]));
        add_words_of(operation_);
        for (const char* name : kRequestHeaders)
            operation_["parameters"].push_back(reference(std::string("parameters/") + name));
        operation_.erase(kProblems);
        if (operation_.value(kRelays, false)) add_all_of_these_statuses();
        operation_.erase(kRelays);
        // Answers come last, whatever was added before.
        Json answers = std::move(operation_["responses"]);
        operation_.erase("responses");
        for (const auto& [status, words] : words_)
            answers[std::to_string(status)] = refusal(status, words);
        for (auto& answer : answers)
            answer = with_headers(resolved(answer));
        add_examples(answers);
        operation_["responses"] = std::move(answers);
    }

  private:
    /// What a "$ref" means, or the value itself.
    const Json& resolved(const Json& value) const {
        if (!value.contains("$ref")) return value;
        const auto text = value["$ref"].get<std::string>();
        return document_.at(Json::json_pointer(text.substr(1)));
    }

    void add_query() {
        if (operation_.contains(kQuery)) {
            const auto schema = operation_[kQuery].get<std::string>();
            for (const auto& [name, property] : properties_of(schema).items())
                add_parameter(schema, name);
        }
        if (operation_.contains(kMeshQuery)) {
            for (const auto& name : operation_[kMeshQuery])
                add_parameter("MeshOptions", name.get<std::string>());
        }
        operation_.erase(kQuery);
        operation_.erase(kMeshQuery);
    }

    const Json& properties_of(const std::string& schema) const {
        return document_["components"]["schemas"][schema]["properties"];
    }

    void add_parameter(const std::string& schema, const std::string& name) {
        const Json& property = resolved(properties_of(schema)[name]);
        Json parameter{{"name", name}, {"in", "query"}};
        if (property.contains("description")) parameter["description"] = property["description"];
        parameter["schema"] = reference("schemas/" + schema + "/properties/" + name);
        operation_["parameters"].push_back(std::move(parameter));
    }

    void add_words_of(const Json& value) {
        if (value.contains(kProblems)) add_words(value[kProblems]);
    }
    void add_words(const Json& words) {
        for (const Json& word : words) {
            const ProblemType type = problem_of_word(word.get<std::string>());
            words_[problem_status(type)].insert(type);
        }
    }

    void add_all_of_these_statuses() {
        for (auto& [status, words] : words_)
            for (const ProblemType type : all_problems())
                if (problem_status(type) == status) words.insert(type);
    }

    Json with_headers(Json answer) const {
        for (const auto& [header, component] : kGeneralHeaders)
            answer["headers"][header] = reference(std::string("headers/") + component);
        for (const auto& [header, component] : answer_headers_.items())
            answer["headers"][header] = reference("headers/" + component.get<std::string>());
        return answer;
    }

    /// Shows the answers that were recorded, each at the first media type that is JSON.
    void add_examples(Json& answers) const {
        const Json& recorded = document_[kRecorded];
        const auto id = operation_["operationId"].get<std::string>();
        if (!recorded.contains(id)) return;
        for (const auto& [status, named] : recorded[id].items()) {
            for (auto& [type, media] : answers[status]["content"].items()) {
                if (type.find("json") == type.npos) continue;
                for (const auto& [name, value] : named.items())
                    media["examples"][name] = {{"value", value}};
                break;
            }
        }
    }

    Json refusal(int status, const std::set<ProblemType>& types) const {
        std::string description;
        Json names = Json::array();
        Json answer = Json::object();
        const Json& headers = document_[kProblems]["headers"];
        for (const ProblemType type : types) {
            const std::string word(problem_word(type));
            description += (description.empty() ? "" : "; ") + std::string(problem_title(type));
            names.push_back(type_of(word));
            if (!headers.contains(word)) continue;
            for (const auto& [header, component] : headers[word].items())
                answer["headers"][header] = reference("headers/" + component.get<std::string>());
        }
        Json schema = reference("schemas/Problem");
        schema["properties"] = {{"type", {{"enum", std::move(names)}}},
                                {"status", {{"const", status}}}};
        answer["description"] = description + ".";
        answer["content"][std::string(kProblemMediaType)]["schema"] = std::move(schema);
        return answer;
    }

    const Json& document_;
    Json& operation_;
    std::map<int, std::set<ProblemType>> words_;
    Json answer_headers_ = Json::object();  ///< that a parameter brings to every answer
};

/// Every problem, as the schema of a problem's type.
Json problem_types() {
    Json all = Json::array();
    for (const ProblemType type : all_problems()) {
        all.push_back({{"const", type_of(problem_word(type))},
                       {"title", problem_title(type)},
                       {"x-status", problem_status(type)}});
    }
    return {{"description", "What sort of refusal it is: stable, for programs."},
            {"oneOf", std::move(all)}};
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the document of this program
void erase_everywhere(Json& value, const char* name) {
    if (value.is_object()) value.erase(name);
    if (!value.is_structured()) return;
    for (Json& part : value)
        erase_everywhere(part, name);
}

std::string make_document() {
    const Json parts = joined_parts();
    Json document = parts;
    for (const auto& [path, item] : document["paths"].items()) {
        for (const auto& [method, operation] : item.items())
            Operation(parts, path, method, operation).complete();
    }
    document["components"]["schemas"]["ProblemType"] = problem_types();
    document["components"].erase("responses");  // each stands where it was named
    for (const char* name : {kProblems, kAnswers, kAnswerHeaders, kRecorded})
        erase_everywhere(document, name);
    return document.dump() + "\n";
}

}  // namespace

const std::string& openapi_document() {
    static const std::string kDocument = make_document();
    return kDocument;
}

}  // namespace tinsmith::api
