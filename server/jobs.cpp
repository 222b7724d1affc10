// SPDX-License-Identifier: Apache-2.0
#include "server/jobs.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <system_error>
#include <utility>

#include "api/problem.hpp"
#include "server/heap.hpp"
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

/// For want of the memory that a body takes.
Response bare(api::ProblemType type) noexcept {
    Response answer;
    answer.status = api::problem_status(type);
    return answer;
}

Response stopped_answer(const Request& request) noexcept {
    try {
        return refuse(request, api::ProblemType::Stopped,
                      "The job was stopped before its work began; nothing was changed.");
    } catch (const std::exception&) {
        return bare(api::ProblemType::Stopped);
    }
}

void log_end(const std::string& id, const Request& request, const Response& answer,
             std::chrono::steady_clock::duration time) noexcept {
    try {
        const double ms = std::chrono::duration<double, std::milli>(time).count();
        log_event(LogLevel::Info, "job_ended", "a job ended",
                  {{"job", id}, {"status", answer.status}, {"ms", ms}, {"request", request.id}});
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

bool Jobs::is_small_enough(const Request& request) const {
    return bytes_of(request) <= bounds_.bytes;
}

bool Jobs::is_at_quota(const Asker& asker) {
    const std::lock_guard lock(mutex_);
    return has_too_many(asker);
}

/// Requires: the lock.
bool Jobs::has_too_many(const Asker& asker) const {
    const auto most = asker.quotas.max_queued_jobs;
    if (!most) return false;
    const auto count = std::count_if(queue_.begin(), queue_.end(), [&asker](const JobPtr& job) {
        return job->owner == asker.id;
    });
    return static_cast<std::size_t>(count) >= *most;
}

std::optional<api::JobView> Jobs::add(Request request, Task task) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const std::size_t bytes = bytes_of(request);
    // What has ended can make room, but only for what then fits.
    const std::size_t live = jobs_.size() - ended_.size();
    if (shutting_down_ || queue_.size() >= bounds_.queued || live >= bounds_.kept ||
        live_bytes_ + bytes > bounds_.bytes || has_too_many(request.asker))
        return std::nullopt;
    auto job = std::make_shared<Job>();
    job->view.id = new_id(++count_);
    job->place.push_back(job->view.id);
    job->id = job->place.begin();
    job->view.method = request.method;
    job->view.path = request.path;
    job->owner = request.asker.id;
    job->request = std::move(request);
    job->request.pass.reset();  // a job is no request in flight
    job->task = std::move(task);
    api::JobView view = view_of(*job);
    const auto share = shares_.try_emplace(job->owner).first;
    auto place = jobs_.end();
    try {
        place = jobs_.emplace(job->view.id, job).first;
        queue_.push_back(job);
        start_thread();
    } catch (...) {
        if (!queue_.empty() && queue_.back() == job) queue_.pop_back();
        if (place != jobs_.end()) jobs_.erase(place);
        if (share->second.jobs == 0) shares_.erase(share);
        throw;
    }
    // From here on nothing fails.
    job->share = &share->second;
    ++job->share->jobs;
    count(*job, bytes);
    live_bytes_ += bytes;
    while (!ended_.empty() && jobs_.size() > bounds_.kept)
        drop_of_largest(&Share::jobs, ended_.end());
    while (!ended_.empty() && bytes_ > bounds_.bytes)
        drop_of_largest(&Share::bytes, ended_.end());
    queue_changed_.notify_one();
    return view;
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
        const bool is_large = job->request.body.size() >= kLargeBody;
        lock.unlock();
        const Time start = clock_();
        Response answer;
        {
            const WorkScope scope(job->work);
            try {
                answer = job->task(job->request);
            } catch (...) {
                // Want of memory, most likely, even for the words to say so. The service goes on.
                answer = bare(api::ProblemType::OutOfMemory);
            }
        }
        if (answer.status < kFirstRefusal) job->work.finish();
        log_end(job->view.id, job->request, answer, clock_() - start);
        lock.lock();
        end(*job, std::move(answer));
        if (!is_large) continue;
        lock.unlock();
        give_back_memory();
        lock.lock();
    }
}

/// Requires: the lock.
void Jobs::end(Job& job, Response answer) noexcept {
    job.view.state = end_of(answer, job.work.stopped());
    job.view.status = answer.status;
    job.view.progress = job.work.progress();
    job.request = {};
    job.task = nullptr;
    if (const Heir heir = std::exchange(job.heir, nullptr)) heir(answer.status);
    job.ended = clock_();
    live_bytes_ -= job.bytes;
    job.view.kept = bytes_of(answer) <= bounds_.bytes;
    if (!job.view.kept) answer = {};
    count(job, bytes_of(answer));
    job.answer = std::move(answer);
    ended_.splice(ended_.end(), job.place);
    while (bytes_ > bounds_.bytes && ended_.size() > 1)
        drop_of_largest(&Share::bytes, std::prev(ended_.end()));
    job_ended_.notify_all();
}

/// The job takes so many bytes now. Requires: the lock.
void Jobs::count(Job& job, std::size_t bytes) noexcept {
    bytes_ += bytes - job.bytes;
    job.share->bytes += bytes - job.bytes;
    job.bytes = bytes;
}

void Jobs::when_ended(const std::string& id, Heir heir) noexcept {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return;
    const api::JobView& view = found->second->view;
    if (api::has_ended(view.state)) {
        heir(view.status);
    } else {
        found->second->heir = std::move(heir);
    }
}

api::JobView Jobs::view_of(const Job& job) {
    api::JobView view = job.view;
    if (!api::has_ended(view.state)) view.progress = job.work.progress();
    return view;
}

/// Of the jobs that ended before that one, drops the first of the asker who has most here.
/// Requires: the lock, and that there is one. Cost: linear in those that have ended.
void Jobs::drop_of_largest(std::size_t Share::*measure, Ended::const_iterator end) noexcept {
    auto most = jobs_.end();
    for (auto id = ended_.cbegin(); id != end; ++id) {
        const auto job = jobs_.find(*id);
        if (most == jobs_.end() || job->second->share->*measure > most->second->share->*measure)
            most = job;
    }
    drop(most);
}

/// Requires: the lock.
void Jobs::drop_old() {
    const Time now = clock_();
    while (!ended_.empty()) {
        const auto oldest = jobs_.find(ended_.front());
        if (now - oldest->second->ended < bounds_.age) return;
        drop(oldest);
    }
}

/// Requires: the lock, and that the job has ended.
void Jobs::drop(JobMap::iterator job) noexcept {
    count(*job->second, 0);
    if (--job->second->share->jobs == 0) shares_.erase(job->second->owner);
    ended_.erase(job->second->id);
    jobs_.erase(job);
}

/// Requires: the lock.
Jobs::JobMap::iterator Jobs::find(const std::string& id, const Asker& asker) {
    const auto found = jobs_.find(id);
    return found != jobs_.end() && asker.may_see(found->second->owner) ? found : jobs_.end();
}

std::optional<api::JobView> Jobs::view(const std::string& id, const Asker& asker) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const auto found = find(id, asker);
    return found == jobs_.end() ? std::nullopt : std::optional(view_of(*found->second));
}

Jobs::Page Jobs::after(const std::string& id, std::size_t limit, const Asker& asker) {
    const std::lock_guard lock(mutex_);
    drop_old();
    Page page;
    for (auto job = jobs_.upper_bound(id); job != jobs_.end(); ++job) {
        if (!asker.may_see(job->second->owner)) continue;
        page.more = page.jobs.size() == limit;
        if (page.more) break;
        page.jobs.push_back(view_of(*job->second));
    }
    return page;
}

Jobs::Counts Jobs::counts() {
    const std::lock_guard lock(mutex_);
    return {queue_.size(), jobs_.size() - ended_.size() - queue_.size()};
}

Jobs::Result Jobs::result(const std::string& id, const Asker& asker) {
    const std::lock_guard lock(mutex_);
    drop_old();
    const auto found = find(id, asker);
    if (found == jobs_.end()) return NoSuchJob{};
    const Job& job = *found->second;
    if (!api::has_ended(job.view.state)) return Unfinished{};
    if (!job.view.kept) return NotKept{};
    return job.answer;
}

std::optional<api::JobView> Jobs::remove(const std::string& id, std::chrono::milliseconds longest,
                                         const Asker& asker) {
    std::unique_lock lock(mutex_);
    drop_old();
    const auto found = find(id, asker);
    if (found == jobs_.end()) return std::nullopt;
    const JobPtr job = found->second;
    if (api::has_ended(job->view.state)) {
        api::JobView view = view_of(*job);
        drop(found);
        return view;
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

void Jobs::stop() {
    const std::lock_guard lock(mutex_);
    shutting_down_ = true;
    for (; !queue_.empty(); queue_.pop_front()) {
        queue_.front()->work.stop();
        end(*queue_.front(), stopped_answer(queue_.front()->request));
    }
    for (const auto& [id, job] : jobs_)
        job->work.stop();
    queue_changed_.notify_all();
}

void Jobs::shut_down() {
    stop();
    std::vector<std::thread> threads;
    {
        const std::lock_guard lock(mutex_);
        threads.swap(threads_);
    }
    for (std::thread& thread : threads)
        thread.join();
}

}  // namespace tinsmith::server
