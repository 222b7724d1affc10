// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "api/jobs.hpp"
#include "server/http_message.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

/// Requests that are answered later: done one after the other on a few threads of their own, their
/// answers kept for a while.
///
/// Laws: a job is its asker's: for others it is not there; its state goes forward only, from queued
/// over running to one of the three ends, and says what became of the request: `stopped` means that
/// nothing came of it. Jobs that have not ended are never dropped; of those that have, one goes
/// when it is too old, and when there are too many or too many bytes: of the asker who has most of
/// them the one that ended first. So nobody loses a result to others who keep more. Threads are
/// started by the first job.
class Jobs {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Clock = std::function<Time()>;
    using Task = std::function<Response(const Request&)>;

    struct Bounds {
        std::size_t threads = 2;
        std::size_t queued = 64;                           ///< waiting for a thread
        std::size_t kept = 1000;                           ///< in any state
        std::size_t bytes = std::size_t{256} << 20;        ///< bodies of requests and answers
        std::chrono::seconds age = std::chrono::hours(1);  ///< of answers
    };

    explicit Jobs(Bounds bounds, Clock clock = std::chrono::steady_clock::now);
    /// Stops all work and waits for it.
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    /// Takes a request on; nothing: no room, or the service is stopping; then no answer was dropped
    /// for it, or its asker has as many waiting as its quota says. An exception leaves all as it
    /// was. A task that throws is answered 507 without a body.
    std::optional<api::JobView> add(Request request, Task task);

    /// To be told the status of the job's answer when it has ended, at once if it has: before
    /// anyone else sees the end. Under a lock: must neither throw nor call back. Nothing where it
    /// is gone.
    using Heir = std::function<void(int status)>;
    void when_ended(const std::string& id, Heir heir) noexcept;

    /// Whether as many of the asker's jobs wait for a thread as its quota allows.
    bool is_at_quota(const Asker& asker);
    /// Whether there can ever be room for it.
    bool is_small_enough(const Request& request) const;

    std::optional<api::JobView> view(const std::string& id, const Asker& asker = {});

    struct Page {
        std::vector<api::JobView> jobs;
        bool more = false;
    };
    /// In the order in which they came, those after the one of that id, which may be gone.
    Page after(const std::string& id, std::size_t limit, const Asker& asker = {});

    struct Counts {
        std::size_t queued = 0;
        std::size_t running = 0;
    };
    Counts counts();

    struct NoSuchJob {};
    struct Unfinished {};
    struct NotKept {};  ///< it ended, but its answer was too large
    using Result = std::variant<Response, NoSuchJob, Unfinished, NotKept>;
    Result result(const std::string& id, const Asker& asker = {});

    /// Drops a job that has ended; tells any other to stop and waits, for so long at most, until it
    /// has. What it was or is then; it may have been done before it could be stopped.
    std::optional<api::JobView> remove(const std::string& id, std::chrono::milliseconds longest,
                                       const Asker& asker = {});

    /// Tells all to stop and takes no more on. Waits for none.
    void stop();
    /// The same, and waits for those that run.
    void shut_down();

  private:
    /// What one asker has here.
    struct Share {
        std::size_t jobs = 0;
        std::size_t bytes = 0;
    };
    using Ended = std::list<std::string>;

    struct Job {
        api::JobView view;  ///< but for its progress, which the work has
        std::string owner;  ///< the key that asked for it; empty: none did
        Work work;
        Request request;
        Task task;
        Heir heir;
        Response answer;
        std::size_t bytes = 0;
        Time ended;
        Ended place;             ///< its id, to be moved into `ended_`: an end must not fail
        Ended::iterator id;      ///< there, or in `ended_`
        Share* share = nullptr;  ///< its owner's
    };
    using JobPtr = std::shared_ptr<Job>;
    using JobMap = std::map<std::string, JobPtr>;

    static api::JobView view_of(const Job& job);
    bool has_too_many(const Asker& asker) const;
    /// The end where it is not there for them.
    JobMap::iterator find(const std::string& id, const Asker& asker);
    void start_thread();
    void run_jobs();
    void end(Job& job, Response answer) noexcept;
    void drop_old();
    void count(Job& job, std::size_t bytes) noexcept;
    void drop_of_largest(std::size_t Share::*measure, Ended::const_iterator end) noexcept;
    void drop(JobMap::iterator job) noexcept;

    const Bounds bounds_;
    const Clock clock_;
    std::mutex mutex_;
    std::condition_variable queue_changed_;
    std::condition_variable job_ended_;
    JobMap jobs_;  ///< in the order in which they came
    std::deque<JobPtr> queue_;
    Ended ended_;                          ///< ids of those of `jobs_`, in that order
    std::map<std::string, Share> shares_;  ///< of those who have jobs, by their keys
    std::size_t bytes_ = 0;
    std::size_t live_bytes_ = 0;  ///< of those that have not ended
    std::uint64_t count_ = 0;
    bool shutting_down_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace tinsmith::server
