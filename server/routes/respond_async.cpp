// SPDX-License-Identifier: Apache-2.0
#include "server/routes/respond_async.hpp"

#include <memory>
#include <string>
#include <utility>

#include "api/field_list.hpp"
#include "api/jobs.hpp"
#include "server/entity_tag.hpp"
#include "server/reply.hpp"
#include "server/request_key.hpp"

namespace tinsmith::server {

namespace {

constexpr const char* kPreference = "respond-async";
constexpr int kAccepted = 202;

/// Names of preferences are compared without case; their values and parameters are passed over.
bool prefers_a_job(const Request& request) {
    const auto field = combined_field(request, "prefer");
    std::string_view rest = field ? std::string_view(*field) : std::string_view();
    while (!rest.empty()) {
        std::string_view preference = api::take_part(rest, ',');
        std::string_view name = api::take_part(preference, ';');
        if (api::lower_case(api::take_part(name, '=')) == kPreference) return true;
    }
    return false;
}

/// Whether the session that a job was asked of gave way to another of its id. One that is just gone
/// is the handler's to tell.
bool is_another(Services& services, const Request& asked, const PathArguments& arguments,
                const std::string& birth) {
    if (birth.empty()) return false;
    const auto session = services.sessions.find(arguments[0], asked.asker);
    return session && session->facts().birth != birth;
}

Response refuse_successor(const Request& request, const std::string& id) {
    return refuse(request, api::ProblemType::NoSuchSession,
                  "The session \"" + id.substr(0, 64) +
                      "\" was deleted before the job began, and another was made under its id: "
                      "nothing was changed. Ask again if that one is meant.");
}

}  // namespace

Handler deferrable(Services& services, Handler handler, Names names) {
    return [&services, names, handler = std::move(handler)](const Request& request,
                                                            const PathArguments& arguments) {
        std::shared_ptr<Session> session;
        if (names == Names::Session && !arguments.empty()) {
            session = services.sessions.find(arguments[0], request.asker);
            if (!session) return handler(request, arguments);
        }
        if (!prefers_a_job(request)) return handler(request, arguments);
        if (!services.jobs.is_small_enough(request)) {
            return refuse(request, api::ProblemType::TooManyJobs,
                          "The request is larger than all jobs together may be (job_bytes of GET "
                          "/v1/limits); nothing was begun. Ask without Prefer: respond-async.");
        }
        const std::string birth = session ? session->facts().birth : std::string();
        session.reset();  // a job that waits keeps none alive
        const auto job =
            services.jobs.add(request, [&services, handler, arguments, birth,
                                        key = current_request_key()](const Request& asked) {
                const RequestKeyScope scope(key);
                return answer_safely(asked, [&] {
                    return is_another(services, asked, arguments, birth)
                               ? refuse_successor(asked, arguments[0])
                               : handler(asked, arguments);
                });
            });
        if (!job && services.jobs.is_at_quota(request.asker)) {
            return refuse(request, api::ProblemType::TooManyRequests,
                          "As many jobs of this key wait as its quota max_queued_jobs of " +
                              std::to_string(request.asker.quotas.max_queued_jobs.value_or(0)) +
                              " allows; nothing was begun. Ask again in a moment, or without "
                              "Prefer: respond-async.")
                .with("Retry-After", "5");
        }
        if (!job) {
            return refuse(request, api::ProblemType::TooManyJobs,
                          "The server has as many jobs as it takes; nothing was begun. Ask again "
                          "in a moment, or without Prefer: respond-async.")
                .with("Retry-After", "5");
        }
        Response response{kAccepted, kJson, {}, api::write_job(*job), false};
        return response.with("Location", "/v1/jobs/" + job->id)
            .with("Preference-Applied", kPreference);
    };
}

}  // namespace tinsmith::server
