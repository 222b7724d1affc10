// SPDX-License-Identifier: Apache-2.0
// Requests that are answered later: how far they are, what came of them, and their end.
#include <chrono>
#include <string>
#include <utility>

#include "api/jobs.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "job";

/// For work to notice that it was stopped. What takes longer is between two questions, as when a
/// mesh is being built.
constexpr std::chrono::seconds kPatience{10};
constexpr int kAccepted = 202;

Response no_such_job(const Request& request, const std::string& id) {
    return refuse(request, api::ProblemType::NoSuchJob,
                  "No job has the id \"" + id.substr(0, 64) +
                      "\": it never was, it was deleted, or its answer was kept for as long as "
                      "this server does. GET /v1/jobs lists them.");
}

Response tell(const api::JobView& job) {
    Response response = ok(kJson, api::write_job(job));
    return api::has_ended(job.state) ? response : response.with("Retry-After", "1");
}

/// What became of it, as an answer.
struct Told {
    const Request& request;
    const std::string& id;

    Response operator()(Response& answer) const { return std::move(answer); }
    Response operator()(Jobs::NoSuchJob) const { return no_such_job(request, id); }
    Response operator()(Jobs::Unfinished) const {
        return refuse(request, api::ProblemType::JobUnfinished,
                      "There is no answer yet: GET /v1/jobs/" + id + " says how far it is.")
            .with("Retry-After", "1");
    }
    Response operator()(Jobs::NotKept) const {
        return refuse(request, api::ProblemType::AnswerNotKept,
                      "The job has ended, but its answer was larger than job_bytes. What it did "
                      "is done: GET the session or its mesh instead.");
    }
};

}  // namespace

Response list_jobs(Services& services, const Request& request, const PathArguments&) {
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const auto& [limit, after] = std::get<0>(page);
    const Jobs::Page jobs = services.jobs.after(after, limit, request.asker);
    Response response = ok(kJson, api::write_jobs(jobs.jobs));
    if (jobs.more) {
        response.with("Link", next_link(request, kCursorKind, limit, jobs.jobs.back().id));
    }
    return response;
}

Response get_job(Services& services, const Request& request, const PathArguments& arguments) {
    const auto job = services.jobs.view(arguments[0], request.asker);
    return job ? tell(*job) : no_such_job(request, arguments[0]);
}

Response get_job_result(Services& services, const Request& request,
                        const PathArguments& arguments) {
    auto result = services.jobs.result(arguments[0], request.asker);
    return std::visit(Told{request, arguments[0]}, result);
}

Response delete_job(Services& services, const Request& request, const PathArguments& arguments) {
    if (!request.body.empty()) {
        return refuse(request, api::ProblemType::BadRequest,
                      "There is no body here: leave it out.");
    }
    const auto job = services.jobs.remove(arguments[0], kPatience, request.asker);
    if (!job) return no_such_job(request, arguments[0]);
    Response response = tell(*job);
    if (!api::has_ended(job->state)) response.status = kAccepted;
    return response;
}

}  // namespace tinsmith::server
