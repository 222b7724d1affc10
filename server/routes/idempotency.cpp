// SPDX-License-Identifier: Apache-2.0
#include "server/routes/idempotency.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "server/digest.hpp"
#include "server/entity_tag.hpp"
#include "server/reply.hpp"
#include "server/request_key.hpp"

namespace tinsmith::server {

namespace {

using api::ProblemType;

constexpr std::size_t kLongestKey = 255;
constexpr int kAccepted = 202;

/// `"abc"` as the draft wants it, or abc as most clients send it: the same key.
std::optional<std::string> key_in(std::string_view field) {
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
        field = field.substr(1, field.size() - 2);
    }
    const bool is_plain = std::all_of(field.begin(), field.end(), [](char c) {
        return c > ' ' && c <= '~' && c != '"' && c != '\\' && c != ',';
    });
    if (field.empty() || field.size() > kLongestKey || !is_plain) return std::nullopt;
    return std::string(field);
}

std::string print_of(const Request& request) {
    std::string query;
    for (const auto& [name, value] : request.query) {
        for (const std::string& text : {name, value}) {
            query += text;
            query += '\n';  // control characters are in neither
        }
    }
    const std::array<std::string_view, 5> parts{request.method, request.path, query,
                                                request.header("content-type").value_or(""),
                                                request.body};
    return sha256_of(parts);
}

/// Of two API keys neither gets the other's answers, nor pushes them out of what belongs to no
/// session. There are no spaces in Idempotency-Keys.
KeptAnswers::Name name_of(const Session* session, const Asker& asker, const std::string& key) {
    if (asker.id.empty()) return {session ? session->facts().birth : std::string(), key};
    if (session == nullptr) return {"key " + asker.id, key};
    return {session->facts().birth, asker.id + ' ' + key};
}

bool is_worth_keeping(int status) {
    static constexpr std::array kOfTheMoment{
        ProblemType::NotAcceptable, ProblemType::VersionMismatch, ProblemType::UnsupportedMediaType,
        ProblemType::PreconditionRequired, ProblemType::TooManySessions};
    static constexpr int kServerErrors = 500;
    return status < kServerErrors &&
           std::none_of(kOfTheMoment.begin(), kOfTheMoment.end(),
                        [status](ProblemType type) { return api::problem_status(type) == status; });
}

/// The promise of a job was kept as the answer: it goes where the job comes to an answer that would
/// not have been kept itself.
void follow_job(Services& services, const Response& promise, const KeptAnswers::Name& name,
                std::uint64_t number) {
    const auto where = std::find_if(promise.headers.begin(), promise.headers.end(),
                                    [](const NameValue& h) { return h.first == "Location"; });
    if (where == promise.headers.end()) return;
    const std::string id = where->second.substr(where->second.rfind('/') + 1);
    services.jobs.when_ended(id, [&answers = services.answers, name, number](int status) {
        if (!is_worth_keeping(status)) answers.take_back(name, number);
    });
}

/// Lets go of the key where no answer was kept, exceptions included.
class Claim {
  public:
    Claim(KeptAnswers& answers, const KeptAnswers::Name& name) : answers_(answers), name_(name) {}
    ~Claim() { answers_.drop(name_); }
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;

  private:
    KeptAnswers& answers_;
    const KeptAnswers::Name& name_;
};

/// What ends the request before the handler; nothing: go on.
struct Refusals {
    const Request& request;

    std::optional<Response> operator()(KeptAnswers::GoOn) const { return std::nullopt; }
    std::optional<Response> operator()(Response& first) const {
        return std::move(first.with("Idempotency-Replayed", "true"));
    }
    std::optional<Response> operator()(KeptAnswers::OtherRequest) const {
        return refuse(request, ProblemType::KeyReused,
                      "This Idempotency-Key came with another request before (method, path, query, "
                      "type or body differ): take a new key for each new request.");
    }
    std::optional<Response> operator()(KeptAnswers::StillRunning) const {
        return refuse(request, ProblemType::KeyInUse,
                      "The first request of this Idempotency-Key is still running: ask again in a "
                      "moment, with the same key.")
            .with("Retry-After", "1");
    }
    std::optional<Response> operator()(KeptAnswers::NoBody) const {
        return refuse(
            request, ProblemType::AnswerNotKept,
            "This request was done once and is not done again; its answer is not kept, for "
            "it was large or others came after it. GET the session or its mesh instead.");
    }
};

}  // namespace

Handler keyed(Services& services, Handler handler) {
    return [&services, handler = std::move(handler)](const Request& request,
                                                     const PathArguments& arguments) {
        const auto field = combined_field(request, "idempotency-key");
        if (!field) return handler(request, arguments);
        auto key = key_in(*field);
        if (!key) {
            return refuse(request, ProblemType::BadRequest,
                          "Idempotency-Key takes 1 to 255 printable characters without spaces, "
                          "commas, quotes and backslashes; a UUID is a good one.");
        }
        const auto session =
            arguments.empty() ? nullptr : services.sessions.find(arguments[0], request.asker);
        if (!arguments.empty() && !session) return handler(request, arguments);
        const KeptAnswers::Name name = name_of(session.get(), request.asker, *key);
        std::string print = print_of(request);
        auto verdict = services.answers.begin(name, print);
        if (std::holds_alternative<Response>(verdict)) services.metrics.answer_replayed();
        if (auto refusal = std::visit(Refusals{request}, verdict)) return *std::move(refusal);
        const Claim claim(services.answers, name);
        const RequestKeyScope scope({name.second, std::move(print), name.first});
        Response response = handler(request, arguments);
        if (is_worth_keeping(response.status)) {
            const std::uint64_t number = services.answers.keep(name, response);
            if (response.status == kAccepted) follow_job(services, response, name, number);
        }
        return response;
    };
}

}  // namespace tinsmith::server
