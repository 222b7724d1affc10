// SPDX-License-Identifier: Apache-2.0
#include "server/routes/respond_async.hpp"

#include <utility>

#include "api/field_list.hpp"
#include "api/jobs.hpp"
#include "server/entity_tag.hpp"
#include "server/reply.hpp"

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

}  // namespace

Handler deferrable(Services& services, Handler handler, Names names) {
    return [&services, names, handler = std::move(handler)](const Request& request,
                                                            const PathArguments& arguments) {
        const bool is_nowhere =
            names == Names::Session && !arguments.empty() && !services.sessions.find(arguments[0]);
        if (is_nowhere || !prefers_a_job(request)) return handler(request, arguments);
        if (!services.jobs.is_small_enough(request)) {
            return refuse(request, api::ProblemType::TooManyJobs,
                          "The request is larger than all jobs together may be (job_bytes of GET "
                          "/v1/limits); nothing was begun. Ask without Prefer: respond-async.");
        }
        const auto job = services.jobs.add(request, [handler, arguments](const Request& asked) {
            return answer_safely(asked, [&] { return handler(asked, arguments); });
        });
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
