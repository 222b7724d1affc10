// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

/// A problem as the server writes them, whoever says it. Empty `path`: any.
inline void expect_problem(const Answer& answer, int status, const std::string& word,
                           const std::string& path = {}) {
    ASSERT_EQ(answer.status, status) << answer.body;
    EXPECT_EQ(answer.header("content-type"), "application/problem+json");
    const auto problem = nlohmann::json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(problem.is_object()) << answer.body;
    EXPECT_EQ(problem.size(), 6U) << answer.body;
    EXPECT_EQ(problem.value("type", ""), "urn:tinsmith:problem:" + word);
    EXPECT_EQ(problem.value("status", 0), status);
    EXPECT_NE(problem.value("title", ""), "");
    EXPECT_NE(problem.value("detail", ""), "");
    EXPECT_NE(problem.value("request_id", ""), "");
    EXPECT_EQ(problem.value("request_id", ""), answer.header("x-request-id"));
    EXPECT_NE(problem.value("instance", "none"), "none");
    if (!path.empty()) {
        EXPECT_EQ(problem.value("instance", ""), path);
    }
}

}  // namespace tinsmith::e2e
