// SPDX-License-Identifier: Apache-2.0
#include "api/jobs.hpp"

#include <utility>

#include <nlohmann/json.hpp>

namespace tinsmith::api {

namespace {

using Json = nlohmann::ordered_json;

std::string_view word_of(JobState state) {
    switch (state) {
        case JobState::Queued:
            return "queued";
        case JobState::Running:
            return "running";
        case JobState::Done:
            return "done";
        case JobState::Failed:
            return "failed";
        case JobState::Stopped:
            break;
    }
    return "stopped";
}

Json json_of(const JobView& job) {
    Json json{{"id", job.id},
              {"state", word_of(job.state)},
              {"progress", job.progress},
              {"request", {{"method", job.method}, {"path", job.path}}}};
    json["status"] = job.status != 0 ? Json(job.status) : Json(nullptr);
    json["result"] = job.kept ? Json("/v1/jobs/" + job.id + "/result") : Json(nullptr);
    return json;
}

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string write_job(const JobView& job) {
    return text_of(json_of(job));
}

std::string write_jobs(std::span<const JobView> jobs) {
    Json list = Json::array();
    for (const JobView& job : jobs)
        list.push_back(json_of(job));
    return text_of({{"jobs", std::move(list)}});
}

}  // namespace tinsmith::api
