// SPDX-License-Identifier: Apache-2.0
#include "server/jobs.hpp"

#include <atomic>
#include <future>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "server/log.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {
namespace {

using api::JobState;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kLong{60'000};

class JobsTest : public testing::Test {
  protected:
    void SetUp() override { set_log_level(LogLevel::Off); }
    void TearDown() override { set_log_level(LogLevel::Info); }

    static Request request(std::string body = {}) {
        Request request;
        request.method = "POST";
        request.path = "/v1/x";
        request.body = std::move(body);
        request.id = "r";
        return request;
    }

    /// Answers at once.
    static Response answer(const Request& request) { return ok("text/plain", request.body); }

    /// Runs until it is stopped, and says when it has begun.
    static Response endless(std::promise<void>& begun, const Request& request) {
        begun.set_value();
        while (!told_to_stop())
            std::this_thread::yield();
        return refuse(request, api::ProblemType::Stopped, "Stopped.");
    }

    static JobState state(Jobs& jobs, const std::string& id) { return jobs.view(id).value().state; }

    /// Waits for the end: `result` is there from then on.
    static Response wait(Jobs& jobs, const std::string& id) {
        for (;;) {
            auto result = jobs.result(id);
            if (auto* response = std::get_if<Response>(&result)) return *response;
            if (!std::holds_alternative<Jobs::Unfinished>(result)) return {};
            std::this_thread::yield();
        }
    }
};

TEST_F(JobsTest, AnswerLater) {
    Jobs jobs({});
    const auto job = jobs.add(request("hello"), answer);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->method, "POST");
    EXPECT_EQ(job->path, "/v1/x");
    EXPECT_EQ(wait(jobs, job->id).body, "hello");
    const auto view = jobs.view(job->id);
    EXPECT_EQ(view->state, JobState::Done);
    EXPECT_EQ(view->progress, 1.0);
    EXPECT_EQ(view->status, 200);
    EXPECT_TRUE(view->kept);
    EXPECT_EQ(jobs.remove(job->id, kLong)->state, JobState::Done);
    EXPECT_FALSE(jobs.view(job->id));
    EXPECT_FALSE(jobs.remove(job->id, kLong));
    EXPECT_TRUE(std::holds_alternative<Jobs::NoSuchJob>(jobs.result(job->id)));
}

TEST_F(JobsTest, FailWhereTheRequestIsRefused) {
    Jobs jobs({});
    const auto job = jobs.add(request(), [](const Request& asked) {
        return refuse(asked, api::ProblemType::BadRequest, "No.");
    });
    EXPECT_EQ(wait(jobs, job->id).status, 400);
    EXPECT_EQ(state(jobs, job->id), JobState::Failed);
}

TEST_F(JobsTest, StopWhatRunsAndWhatWaits) {
    Jobs jobs({.threads = 1});
    std::promise<void> begun;
    const auto running =
        jobs.add(request(), [&begun](const Request& r) { return endless(begun, r); });
    std::atomic<bool> was_run{false};
    const auto waiting = jobs.add(request(), [&was_run](const Request& r) {
        was_run = true;
        return answer(r);
    });
    begun.get_future().wait();
    EXPECT_EQ(state(jobs, running->id), JobState::Running);
    EXPECT_EQ(state(jobs, waiting->id), JobState::Queued);
    EXPECT_TRUE(std::holds_alternative<Jobs::Unfinished>(jobs.result(waiting->id)));
    EXPECT_EQ(jobs.remove(waiting->id, kLong)->state, JobState::Stopped);
    EXPECT_EQ(state(jobs, waiting->id), JobState::Stopped) << "still told";
    EXPECT_EQ(jobs.remove(running->id, kLong)->state, JobState::Stopped);
    EXPECT_EQ(wait(jobs, running->id).status, 503);
    EXPECT_FALSE(was_run);
    EXPECT_EQ(jobs.remove(running->id, kLong)->state, JobState::Stopped);
    EXPECT_FALSE(jobs.view(running->id)) << "the second time it is deleted";
}

TEST_F(JobsTest, StandWhereTheyWereStopped) {
    Jobs jobs({});
    std::promise<void> begun;
    const auto job = jobs.add(request(), [&begun](const Request& r) {
        begin_stage(1.0);
        stage_progress()(0.25);
        return endless(begun, r);
    });
    begun.get_future().wait();
    EXPECT_EQ(jobs.remove(job->id, kLong)->progress, 0.25);
}

TEST_F(JobsTest, AreDoneWhereTheStopComesTooLate) {
    Jobs jobs({});
    std::promise<void> begun;
    const auto job = jobs.add(request("made"), [&begun](const Request& r) {
        endless(begun, r);
        return answer(r);  // past the point of no return
    });
    begun.get_future().wait();
    EXPECT_EQ(jobs.remove(job->id, kLong)->state, JobState::Done);
    EXPECT_EQ(wait(jobs, job->id).body, "made");
}

TEST_F(JobsTest, DoNotWaitForEver) {
    Jobs jobs({});
    std::promise<void> begun, may_end;
    const auto job = jobs.add(request(), [&](const Request& r) {
        begun.set_value();
        may_end.get_future().wait();
        return answer(r);
    });
    begun.get_future().wait();
    EXPECT_EQ(jobs.remove(job->id, milliseconds(1))->state, JobState::Running);
    may_end.set_value();
    EXPECT_EQ(wait(jobs, job->id).status, 200);
}

TEST_F(JobsTest, TellProgress) {
    Jobs jobs({});
    std::promise<void> half, go_on;
    const auto job = jobs.add(request(), [&](const Request& r) {
        begin_stage(1.0);
        stage_progress()(0.5);
        half.set_value();
        go_on.get_future().wait();
        return answer(r);
    });
    half.get_future().wait();
    EXPECT_EQ(jobs.view(job->id)->progress, 0.5);
    go_on.set_value();
    wait(jobs, job->id);
    EXPECT_EQ(jobs.view(job->id)->progress, 1.0);
}

TEST_F(JobsTest, AreBoundedInNumber) {
    Jobs jobs({.threads = 1, .queued = 2, .kept = 4});
    std::promise<void> begun;
    const auto running =
        jobs.add(request(), [&begun](const Request& r) { return endless(begun, r); });
    begun.get_future().wait();
    const auto second = jobs.add(request(), answer);
    EXPECT_TRUE(second);
    EXPECT_TRUE(jobs.add(request(), answer));
    EXPECT_FALSE(jobs.add(request(), answer)) << "the queue is full";
    jobs.remove(running->id, kLong);
    wait(jobs, second->id);
    for (int i = 0; i < 20; ++i) {
        const auto job = jobs.add(request(), answer);
        ASSERT_TRUE(job);
        wait(jobs, job->id);
        EXPECT_LE(jobs.after("", 100).jobs.size(), 4U);
    }
    EXPECT_FALSE(jobs.view(running->id)) << "the first that ended goes first";
}

TEST_F(JobsTest, AreBoundedInBytes) {
    Jobs jobs({.bytes = 10'000});
    EXPECT_FALSE(jobs.add(request(std::string(20'000, 'x')), answer));
    const auto first = jobs.add(request(std::string(4'000, 'x')), answer);
    wait(jobs, first->id);
    const auto second = jobs.add(request(std::string(4'000, 'x')), answer);
    wait(jobs, second->id);
    const auto third = jobs.add(request(std::string(4'000, 'x')), answer);
    EXPECT_EQ(wait(jobs, third->id).body.size(), 4'000U);
    EXPECT_FALSE(jobs.view(first->id));
    const auto large = jobs.add(
        request(), [](const Request&) { return ok("text/plain", std::string(20'000, 'y')); });
    while (!api::has_ended(state(jobs, large->id)))
        std::this_thread::yield();
    EXPECT_TRUE(std::holds_alternative<Jobs::NotKept>(jobs.result(large->id)));
    EXPECT_EQ(state(jobs, large->id), JobState::Done);
    EXPECT_FALSE(jobs.view(large->id)->kept);
}

TEST_F(JobsTest, SurviveATaskThatThrows) {
    Jobs jobs({.threads = 1});
    const auto job =
        jobs.add(request(), [](const Request&) -> Response { throw std::bad_alloc(); });
    EXPECT_EQ(wait(jobs, job->id).status, 507);
    EXPECT_EQ(state(jobs, job->id), JobState::Failed);
    EXPECT_EQ(wait(jobs, jobs.add(request("next"), answer)->id).body, "next");
}

TEST_F(JobsTest, KeepAnswersWhereOneIsRefused) {
    Jobs jobs({.threads = 1, .kept = 3, .bytes = 10'000});
    std::vector<std::string> ids;
    for (int i = 0; i < 2; ++i) {
        ids.push_back(jobs.add(request("small"), answer)->id);
        wait(jobs, ids.back());
    }
    EXPECT_FALSE(jobs.is_small_enough(request(std::string(20'000, 'x'))));
    EXPECT_FALSE(jobs.add(request(std::string(20'000, 'x')), answer));
    EXPECT_EQ(jobs.after("", 10).jobs.size(), 2U) << "it could not have helped to drop them";
    std::promise<void> begun;
    const auto running = jobs.add(request(std::string(4'000, 'x')),
                                  [&begun](const Request& r) { return endless(begun, r); });
    begun.get_future().wait();
    EXPECT_TRUE(jobs.is_small_enough(request(std::string(7'000, 'x'))));
    EXPECT_FALSE(jobs.add(request(std::string(7'000, 'x')), answer)) << "one that runs takes it";
    EXPECT_EQ(jobs.after("", 10).jobs.size(), 3U);
    EXPECT_TRUE(jobs.add(request(), answer));
    EXPECT_FALSE(jobs.view(ids[0])) << "the first that ended made room";
    EXPECT_TRUE(jobs.view(ids[1]));
    EXPECT_TRUE(jobs.add(request(), answer));
    EXPECT_FALSE(jobs.add(request(), answer)) << "as many that have not ended as there may be";
    EXPECT_EQ(jobs.after("", 10).jobs.size(), 3U);
}

TEST_F(JobsTest, KeepTheLastAnswerWhateverWasDeletedBefore) {
    Jobs jobs({.threads = 1, .bytes = 10'000});
    wait(jobs, jobs.add(request(), answer)->id);
    for (int i = 0; i < 5; ++i) {
        const auto gone = jobs.add(request(), answer);
        wait(jobs, gone->id);
        jobs.remove(gone->id, kLong);
    }
    std::promise<void> begun, first_may_end, second_may_end;
    const auto first = jobs.add(request(), [&](const Request&) {
        begun.set_value();
        first_may_end.get_future().wait();
        return ok("text/plain", std::string(8'000, 'y'));
    });
    begun.get_future().wait();
    const auto second = jobs.add(request(std::string(4'000, 'x')), [&](const Request& r) {
        second_may_end.get_future().wait();
        return answer(r);
    });
    first_may_end.set_value();
    EXPECT_EQ(wait(jobs, first->id).body.size(), 8'000U)
        << "too much for as long as both are there";
    second_may_end.set_value();
    EXPECT_EQ(wait(jobs, second->id).body.size(), 4'000U);
    EXPECT_FALSE(jobs.view(first->id));
}

TEST_F(JobsTest, TellTheirEnd) {
    Jobs jobs({.threads = 1});
    std::promise<void> begun;
    const auto running =
        jobs.add(request(), [&begun](const Request& r) { return endless(begun, r); });
    const auto waiting = jobs.add(request(), answer);
    std::vector<int> told;
    const Jobs::Heir heir = [&told](int status) { told.push_back(status); };
    jobs.when_ended(waiting->id, heir);
    jobs.when_ended(running->id, heir);
    jobs.when_ended("none", heir);
    begun.get_future().wait();
    EXPECT_TRUE(told.empty());
    jobs.remove(waiting->id, kLong);
    EXPECT_EQ(told, std::vector<int>{503}) << "it never began";
    jobs.remove(running->id, kLong);
    EXPECT_EQ(told.size(), 2U);
    const auto done = jobs.add(request(), answer);
    wait(jobs, done->id);
    jobs.when_ended(done->id, heir);
    EXPECT_EQ(told, (std::vector<int>{503, 503, 200})) << "at once where it has ended";
}

TEST_F(JobsTest, AreToldToStopBeforeTheyAreWaitedFor) {
    Jobs jobs({.threads = 1});
    std::promise<void> begun, may_end;
    const auto blocked = jobs.add(request(), [&](const Request& r) {
        begun.set_value();
        may_end.get_future().wait();  // as for a session that a request has locked
        return told_to_stop() ? refuse(r, api::ProblemType::Stopped, "Stopped.") : answer(r);
    });
    const auto waiting = jobs.add(request(), answer);
    begun.get_future().wait();
    jobs.stop();
    EXPECT_EQ(state(jobs, blocked->id), JobState::Running);
    EXPECT_EQ(state(jobs, waiting->id), JobState::Stopped);
    EXPECT_FALSE(jobs.add(request(), answer));
    may_end.set_value();
    jobs.shut_down();
    EXPECT_EQ(state(jobs, blocked->id), JobState::Stopped);
}

TEST_F(JobsTest, AreKeptForATime) {
    std::atomic<long> now{0};
    Jobs jobs({.age = seconds(100)}, [&now] { return Jobs::Time(seconds(now)); });
    const auto job = jobs.add(request(), answer);
    wait(jobs, job->id);
    now = 99;
    EXPECT_TRUE(jobs.view(job->id));
    now = 100;
    EXPECT_FALSE(jobs.view(job->id));
    EXPECT_TRUE(jobs.after("", 10).jobs.empty());
}

TEST_F(JobsTest, ComeInPagesInTheirOrder) {
    Jobs jobs({});
    std::vector<std::string> ids;
    for (int i = 0; i < 5; ++i)
        ids.push_back(jobs.add(request(), answer)->id);
    const auto first = jobs.after("", 3);
    ASSERT_EQ(first.jobs.size(), 3U);
    EXPECT_TRUE(first.more);
    wait(jobs, ids[2]);
    jobs.remove(ids[2], kLong);
    const auto rest = jobs.after(first.jobs.back().id, 3);
    ASSERT_EQ(rest.jobs.size(), 2U);
    EXPECT_FALSE(rest.more);
    EXPECT_EQ(rest.jobs[0].id, ids[3]);
}

TEST_F(JobsTest, StopWithTheService) {
    std::promise<void> begun;
    Jobs jobs({.threads = 1});
    const auto running =
        jobs.add(request(), [&begun](const Request& r) { return endless(begun, r); });
    const auto waiting = jobs.add(request(), answer);
    begun.get_future().wait();
    jobs.shut_down();
    EXPECT_EQ(state(jobs, running->id), JobState::Stopped);
    EXPECT_EQ(state(jobs, waiting->id), JobState::Stopped);
    EXPECT_FALSE(jobs.add(request(), answer));
}

TEST_F(JobsTest, RaceTheirEnd) {
    Jobs jobs({.threads = 4, .queued = 1000, .kept = 1000});
    std::vector<std::string> ids;
    for (int i = 0; i < 400; ++i) {
        const auto job = jobs.add(request(), [](const Request& r) {
            return told_to_stop() ? refuse(r, api::ProblemType::Stopped, "Stopped.") : answer(r);
        });
        ids.push_back(job->id);
    }
    std::vector<std::thread> threads;
    std::atomic<int> ends{0};
    for (int t = 0; t < 3; ++t) {
        threads.emplace_back([&] {
            for (const std::string& id : ids) {
                const auto view = jobs.remove(id, kLong);
                if (view && api::has_ended(view->state)) ++ends;
                jobs.after("", 10);
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_GE(ends, 400);
    for (const std::string& id : ids) {
        const auto view = jobs.view(id);
        EXPECT_TRUE(!view || api::has_ended(view->state));
    }
}

}  // namespace
}  // namespace tinsmith::server
