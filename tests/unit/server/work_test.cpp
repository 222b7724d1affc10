// SPDX-License-Identifier: Apache-2.0
#include "server/work.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::server {
namespace {

TEST(Work, GoesThroughStagesAndNeverBack) {
    Work work;
    EXPECT_EQ(work.progress(), 0.0);
    work.begin_stage(0.5);
    work.at(0.5);
    EXPECT_DOUBLE_EQ(work.progress(), 0.25);
    work.at(0.1);
    EXPECT_DOUBLE_EQ(work.progress(), 0.25) << "less than before is passed over";
    work.at(7.0);
    EXPECT_DOUBLE_EQ(work.progress(), 0.5);
    work.begin_stage(0.5);
    work.begin_stage(1.0);
    EXPECT_DOUBLE_EQ(work.progress(), 0.75);
    work.at(0.5);
    EXPECT_DOUBLE_EQ(work.progress(), 0.875);
    work.finish();
    EXPECT_EQ(work.progress(), 1.0);
}

TEST(Work, TellsEveryHundredth) {
    std::vector<double> told;
    Work work([&told](double progress) { told.push_back(progress); });
    work.begin_stage(1.0);
    for (int i = 0; i <= 100'000; ++i)
        work.at(i / 100'000.0);
    EXPECT_GE(told.size(), 99U);
    EXPECT_LE(told.size(), 101U);
    EXPECT_EQ(told.back(), 1.0);
}

TEST(Work, IsThatOfOneThread) {
    Work outer, inner;
    EXPECT_EQ(current_work(), nullptr);
    EXPECT_FALSE(stage_progress());
    EXPECT_FALSE(reading_progress());
    {
        const WorkScope scope(outer);
        EXPECT_EQ(current_work(), &outer);
        {
            const WorkScope nested(inner);
            EXPECT_EQ(current_work(), &inner);
        }
        EXPECT_EQ(current_work(), &outer);
        std::thread([] { EXPECT_EQ(current_work(), nullptr); }).join();
        outer.begin_stage(1.0);
        EXPECT_TRUE(reading_progress()(0.5));
        outer.stop();
        EXPECT_FALSE(reading_progress()(0.6));
        EXPECT_TRUE(told_to_stop());
    }
    EXPECT_FALSE(told_to_stop());
}

TEST(Work, EndsADeadline) {
    Limits limits;
    std::atomic<bool> stopping{false};
    EXPECT_FALSE(deadline(limits, stopping)());
    Work work;
    const WorkScope scope(work);
    const auto is_over = deadline(limits, stopping);
    EXPECT_FALSE(is_over());
    work.stop();
    EXPECT_TRUE(is_over());
    limits.max_edit_seconds = 0.0;
    EXPECT_TRUE(deadline(limits, stopping)());
}

}  // namespace
}  // namespace tinsmith::server
