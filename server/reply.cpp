// SPDX-License-Identifier: Apache-2.0
#include "server/reply.hpp"

#include <utility>

namespace tinsmith::server {

Response ok(std::string content_type, std::string body) {
    return {200, std::move(content_type), {}, std::move(body), false};
}

Response created(std::string location, std::string content_type, std::string body) {
    Response response{201, std::move(content_type), {}, std::move(body), false};
    response.with("Location", std::move(location));
    return response;
}

Response not_modified(std::string etag) {
    Response response{304, {}, {}, {}, false};
    response.with("ETag", std::move(etag));
    return response;
}

Response refuse(const Request& request, const api::Problem& problem) {
    Response response{api::problem_status(problem.type),
                      std::string(api::kProblemMediaType),
                      {},
                      api::write_problem(problem, request.path, request.id),
                      false};
    response.problem = api::problem_word(problem.type);
    return response;
}

Response refuse(const Request& request, api::ProblemType type, std::string detail) {
    return refuse(request, api::Problem{type, std::move(detail), {}});
}

}  // namespace tinsmith::server
