// SPDX-License-Identifier: Apache-2.0
#include "server/jobs.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <system_error>
#include <utility>

#include "api/problem.hpp"
#include "server/log.hpp"
#include "server/random_id.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

constexpr int kFirstRefusal = 400;

std::size_t bytes_of(const Request& request) {
    return sizeof request + request.body.size() + request.path.size();
}

std::size_t bytes_of(const Response& answer) {
    std::size_t bytes = sizeof answer + answer.body.size();
    for (const auto& [name, value] : answer.headers)
        bytes += sizeof(NameValue) + name.size() + value.size();
    return bytes;
}

/// In growing order, and nobody guesses the id of another's job.
std::string new_id(std::uint64_t count) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%012llx-", static_cast<unsigned long long>(count));
    return number.data() + random_hex(8);
}

Response stopped_answer(const Request& request) {
    return refuse(request, api::ProblemType::Stopped,
                  "The job was stopped before its work began; nothing was changed.");
}

void log_end(const std::string& id, const Request& request, const Response& answer,
             std::chrono::steady_clock::duration time) noexcept {
    try {
        const double ms = std::chrono::duration<double, std::milli>(time).count();
        log_info("job " + id + " status=" + std::to_string(answer.status) +
                 " ms=" + std::to_string(ms) + " request=" + request.id);
    } catch (const std::exception&) {
        // Want of memory: the job is done all the same.
    }
}

api::JobState end_of(const Response& answer, bool told_to_stop) {
    if (answer.status < kFirstRefusal) return api::JobState::Done;
    const bool is_stopped = answer.status == api::problem_status(api::ProblemType::Stopped);
    return told_to_stop && is_stopped ? api::JobState::Stopped : api::JobState::Failed;
}

}  // namespace

Jobs::Jobs(Bounds bounds, Clock clock) : bounds_(bounds), clock_(std::move(clock)) {}

Jobs::~Jobs() {
    shut_down();
}

std::optional<api::JobView> Jobs::add(Request request, Task task) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const std::size_t bytes = bytes_of(request);
    if (shutting_down_ || queue_.size() >= bounds_.queued) return std::nullopt;
    while (jobs_.size() >= bounds_.kept || bytes_ + bytes > bounds_.bytes) {
        if (!drop_first_ended()) return std::nullopt;
    }
    auto job = std::make_shared<Job>();
    job->view.id = new_id(++count_);
    job->place.push_back(job->view.id);
    job->view.method = request.method;
    job->view.path = request.path;
    job->request = std::move(request);
    job->task = std::move(task);
    job->bytes = bytes;
    jobs_.emplace(job->view.id, job);
    try {
        queue_.push_back(job);
        start_thread();
    } catch (...) {
        if (!queue_.empty() && queue_.back() == job) queue_.pop_back();
        jobs_.erase(job->view.id);
        throw;
    }
    bytes_ += bytes;
    queue_changed_.notify_one();
    return view_of(*job);
}

/// One more for one more job, up to their number; where the system has none left, those that there
/// are will do. Requires: the lock.
void Jobs::start_thread() {
    if (threads_.size() >= std::min<std::uint64_t>(bounds_.threads, count_)) return;
    try {
        threads_.emplace_back([this] { run_jobs(); });
    } catch (const std::system_error&) {
        if (threads_.empty()) throw;
    }
}

void Jobs::run_jobs() {
    std::unique_lock lock(mutex_);
    for (;;) {
        queue_changed_.wait(lock, [this] { return shutting_down_ || !queue_.empty(); });
        if (queue_.empty()) return;
        const JobPtr job = std::move(queue_.front());
        queue_.pop_front();
        job->view.state = api::JobState::Running;
        lock.unlock();
        const Time start = clock_();
        Response answer;
        {
            const WorkScope scope(job->work);
            answer = job->task(job->request);
        }
        if (answer.status < kFirstRefusal) job->work.finish();
        log_end(job->view.id, job->request, answer, clock_() - start);
        lock.lock();
        end(*job, std::move(answer));
    }
}

/// Requires: the lock.
void Jobs::end(Job& job, Response answer) noexcept {
    job.view.state = end_of(answer, job.work.stopped());
    job.view.status = answer.status;
    job.view.progress = job.work.progress();
    job.request = {};
    job.task = nullptr;
    job.ended = clock_();
    bytes_ -= job.bytes;
    job.bytes = bytes_of(answer);
    job.view.kept = job.bytes <= bounds_.bytes;
    if (!job.view.kept) {
        answer = {};
        job.bytes = bytes_of(answer);
    }
    job.answer = std::move(answer);
    bytes_ += job.bytes;
    ended_.splice(ended_.end(), job.place);
    while (bytes_ > bounds_.bytes && ended_.size() > 1 && drop_first_ended()) {
    }
    job_ended_.notify_all();
}

api::JobView Jobs::view_of(const Job& job) {
    api::JobView view = job.view;
    if (!api::has_ended(view.state)) view.progress = job.work.progress();
    return view;
}

/// Requires: the lock. False: none has ended.
bool Jobs::drop_first_ended() {
    while (!ended_.empty()) {
        const std::string id = std::move(ended_.front());
        ended_.pop_front();
        if (!jobs_.contains(id)) continue;
        drop(id);
        return true;
    }
    return false;
}

/// Requires: the lock.
void Jobs::drop_old() {
    const Time now = clock_();
    while (!ended_.empty()) {
        const auto first = jobs_.find(ended_.front());
        if (first != jobs_.end() && now - first->second->ended < bounds_.age) return;
        if (first != jobs_.end()) drop(first->first);
        ended_.pop_front();
    }
}

/// Requires: the lock, and that the job is there and has ended.
void Jobs::drop(const std::string& id) {
    const auto job = jobs_.find(id);
    bytes_ -= job->second->bytes;
    jobs_.erase(job);
}

std::optional<api::JobView> Jobs::view(const std::string& id) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? std::nullopt : std::optional(view_of(*found->second));
}

Jobs::Page Jobs::after(const std::string& id, std::size_t limit) {
    const std::lock_guard lock(mutex_);
    drop_old();
    Page page;
    for (auto job = jobs_.upper_bound(id); job != jobs_.end(); ++job) {
        page.more = page.jobs.size() == limit;
        if (page.more) break;
        page.jobs.push_back(view_of(*job->second));
    }
    return page;
}

Jobs::Result Jobs::result(const std::string& id) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return NoSuchJob{};
    const Job& job = *found->second;
    if (!api::has_ended(job.view.state)) return Unfinished{};
    if (!job.view.kept) return NotKept{};
    return job.answer;
}

std::optional<api::JobView> Jobs::remove(const std::string& id, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    drop_old();
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return std::nullopt;
    const JobPtr job = found->second;
    if (api::has_ended(job->view.state)) {
        drop(id);
        return view_of(*job);
    }
    job->work.stop();
    const auto waiting = std::find(queue_.begin(), queue_.end(), job);
    if (waiting != queue_.end()) {
        queue_.erase(waiting);
        end(*job, stopped_answer(job->request));
        return view_of(*job);
    }
    job_ended_.wait_for(lock, longest, [&job] { return api::has_ended(job->view.state); });
    return view_of(*job);
}

void Jobs::shut_down() {
    std::vector<std::thread> threads;
    {
        const std::lock_guard lock(mutex_);
        shutting_down_ = true;
        for (const JobPtr& job : std::exchange(queue_, {})) {
            job->work.stop();
            end(*job, stopped_answer(job->request));
        }
        for (const auto& [id, job] : jobs_)
            job->work.stop();
        threads.swap(threads_);
    }
    queue_changed_.notify_all();
    for (std::thread& thread : threads)
        thread.join();
}

}  // namespace tinsmith::server
