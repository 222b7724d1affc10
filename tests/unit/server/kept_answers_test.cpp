// SPDX-License-Identifier: Apache-2.0
#include "server/kept_answers.hpp"

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

using Name = KeptAnswers::Name;

Response answer(const std::string& body) {
    return {200, "text/plain", {{"ETag", "\"x\""}}, body, false};
}

template <typename T>
bool is(const KeptAnswers::Verdict& verdict) {
    return std::holds_alternative<T>(verdict);
}

void do_once(KeptAnswers& answers, const Name& name, const std::string& body = "done") {
    ASSERT_TRUE(is<KeptAnswers::GoOn>(answers.begin(name, "print")));
    answers.keep(name, answer(body));
}

TEST(KeptAnswers, GivesTheFirstAnswerAgain) {
    KeptAnswers answers({});
    const Name name{"birth", "key"};
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin(name, "print")));
    EXPECT_TRUE(is<KeptAnswers::StillRunning>(answers.begin(name, "print")));
    EXPECT_TRUE(is<KeptAnswers::OtherRequest>(answers.begin(name, "other")));
    answers.keep(name, answer("done"));
    EXPECT_EQ(std::get<Response>(answers.begin(name, "print")).body, "done");
    EXPECT_TRUE(is<KeptAnswers::OtherRequest>(answers.begin(name, "other")));
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"another", "key"}, "print")));
}

TEST(KeptAnswers, LetsADroppedOneGoAgain) {
    KeptAnswers answers({});
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"", "key"}, "print")));
    answers.drop({"", "key"});
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"", "key"}, "other")));
    answers.keep({"", "key"}, answer("done"));
    answers.drop({"", "key"});
    EXPECT_TRUE(is<Response>(answers.begin({"", "key"}, "other"))) << "what is kept stays";
}

TEST(KeptAnswers, TakeBackWhatTurnedOutToBeNothing) {
    KeptAnswers answers({});
    do_once(answers, {"birth", "before"});
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"birth", "key"}, "print")));
    const auto number = answers.keep({"birth", "key"}, answer("promised"));
    do_once(answers, {"birth", "after"});
    answers.take_back({"birth", "before"}, number);
    EXPECT_EQ(answers.size(), 3U) << "the number is another's";
    answers.take_back({"birth", "key"}, number);
    EXPECT_EQ(answers.size(), 2U);
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"birth", "key"}, "print")));
    answers.take_back({"birth", "key"}, number);
    EXPECT_TRUE(is<KeptAnswers::StillRunning>(answers.begin({"birth", "key"}, "print")));
    answers.keep({"birth", "key"}, answer("done"));
    answers.take_back({"birth", "key"}, number);
    EXPECT_EQ(std::get<Response>(answers.begin({"birth", "key"}, "print")).body, "done");
    answers.forget("birth");
    EXPECT_EQ(answers.size(), 0U);
    EXPECT_EQ(answers.bytes(), 0U);
}

TEST(KeptAnswers, ForgetAfterADay) {
    KeptAnswers::Time now{};
    KeptAnswers answers({}, [&now] { return now; });
    do_once(answers, {"birth", "key"});
    now += std::chrono::hours(24) - std::chrono::seconds(1);
    EXPECT_TRUE(is<Response>(answers.begin({"birth", "key"}, "print")));
    now += std::chrono::seconds(1);
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"birth", "key"}, "print")));
    EXPECT_EQ(answers.size(), 0U);
    EXPECT_EQ(answers.bytes(), 0U);
    now += std::chrono::hours(99);
    EXPECT_TRUE(is<KeptAnswers::StillRunning>(answers.begin({"birth", "key"}, "print")));
}

TEST(KeptAnswers, KeepTheLastOfEachScope) {
    KeptAnswers answers({.per_scope = 3});
    for (const char* key : {"1", "2", "3", "4"}) {
        do_once(answers, {"a", key});
        do_once(answers, {"b", key});
    }
    EXPECT_EQ(answers.size(), 6U);
    EXPECT_TRUE(is<Response>(answers.begin({"a", "2"}, "print")));
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"a", "1"}, "print")));
}

TEST(KeptAnswers, StayWithinTheirBytes) {
    KeptAnswers answers({.bytes = 100'000});
    for (int i = 0; i < 100; ++i)
        do_once(answers, {"a", std::to_string(i)}, std::string(8000, 'x'));
    EXPECT_LE(answers.bytes(), 100'000U);
    EXPECT_GE(answers.size(), 10U);
    EXPECT_TRUE(is<Response>(answers.begin({"a", "99"}, "print")));
    EXPECT_TRUE(is<KeptAnswers::NoBody>(answers.begin({"a", "0"}, "print")))
        << "it is not done again, without its body";
    for (int i = 100; i < 1000; ++i)
        do_once(answers, {"a", std::to_string(i)});
    EXPECT_LE(answers.bytes(), 100'000U);
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"a", "0"}, "print")));
}

TEST(KeptAnswers, AreNotLostToOthersWhoKeepMore) {
    KeptAnswers answers({.bytes = 100'000});
    do_once(answers, {"small", "first"}, std::string(5'000, 'x'));
    do_once(answers, {"small", "second"});
    for (int i = 0; i < 50; ++i) {
        do_once(answers, {"large", std::to_string(i)}, std::string(8'000, 'x'));
        do_once(answers, {"many", std::to_string(i)}, std::string(2'000, 'x'));
    }
    EXPECT_LE(answers.bytes(), 100'000U);
    EXPECT_TRUE(is<Response>(answers.begin({"small", "first"}, "print")));
    EXPECT_TRUE(is<Response>(answers.begin({"small", "second"}, "print")));
    EXPECT_TRUE(is<Response>(answers.begin({"large", "49"}, "print")));
    for (int i = 0; i < 1000; ++i)
        do_once(answers, {"large", "bare " + std::to_string(i)});
    EXPECT_LE(answers.bytes(), 100'000U);
    EXPECT_FALSE(is<KeptAnswers::GoOn>(answers.begin({"small", "first"}, "print")));
    for (const char* scope : {"small", "large", "many"})
        answers.forget(scope);
    EXPECT_EQ(answers.size(), 0U);
    EXPECT_EQ(answers.bytes(), 0U);
}

TEST(KeptAnswers, RememberWhatWasTooLargeToKeep) {
    KeptAnswers answers({.bytes = 100'000});
    do_once(answers, {"a", "large"}, std::string(50'000, 'x'));
    EXPECT_TRUE(is<KeptAnswers::NoBody>(answers.begin({"a", "large"}, "print")));
    EXPECT_LT(answers.bytes(), 1000U);
}

TEST(KeptAnswers, ForgetASessionButNotWhatRuns) {
    KeptAnswers answers({});
    do_once(answers, {"a", "1"});
    do_once(answers, {"b", "1"});
    do_once(answers, {"a", "2"});
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"a", "3"}, "print")));
    answers.forget("a");
    EXPECT_EQ(answers.size(), 1U);
    EXPECT_TRUE(is<KeptAnswers::StillRunning>(answers.begin({"a", "3"}, "print")));
    answers.keep({"a", "3"}, answer("done"));
    EXPECT_TRUE(is<KeptAnswers::GoOn>(answers.begin({"a", "1"}, "print")));
    EXPECT_TRUE(is<Response>(answers.begin({"b", "1"}, "print")));
}

}  // namespace
}  // namespace tinsmith::server
