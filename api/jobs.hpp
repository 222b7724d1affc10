// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace tinsmith::api {

enum class JobState { Queued, Running, Done, Failed, Stopped };

/// Whether nothing more will become of it.
constexpr bool has_ended(JobState state) {
    return state != JobState::Queued && state != JobState::Running;
}

/// What is told of a request that is answered later.
struct JobView {
    std::string id;
    JobState state = JobState::Queued;
    double progress = 0.0;  ///< from 0 to 1
    std::string method;     ///< of the request
    std::string path;
    int status = 0;     ///< of its answer; 0: there is none yet
    bool kept = false;  ///< the answer can be had
};

/// {"id", "state", "progress", "request": {"method", "path"}, "status", "result"}; the last two are
/// null until it has ended, and "result" where the answer was too large.
std::string write_job(const JobView& job);
/// {"jobs": [...]}
std::string write_jobs(std::span<const JobView> jobs);

}  // namespace tinsmith::api
