// SPDX-License-Identifier: Apache-2.0
#include "api/problem.hpp"

#include <algorithm>
#include <fstream>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tinsmith::api {
namespace {

using nlohmann::json;

TEST(WriteProblem, HasTheMembersOfRfc9457) {
    const Problem problem{ProblemType::NoSuchSession, "No session has the id \"x\".", {}};
    const auto body = json::parse(write_problem(problem, "/v1/sessions/x", "abc"));
    EXPECT_EQ(body["type"], "urn:tinsmith:problem:no-such-session");
    EXPECT_EQ(body["title"], "There is no such session");
    EXPECT_EQ(body["status"], 404);
    EXPECT_EQ(body["detail"], "No session has the id \"x\".");
    EXPECT_EQ(body["instance"], "/v1/sessions/x");
    EXPECT_EQ(body["request_id"], "abc");
    EXPECT_FALSE(body.contains("errors"));
}

TEST(WriteProblem, TellsEveryFaultWithItsPlace) {
    const Problem problem{ProblemType::InvalidContent,
                          "Two faults.",
                          {{"RING_TOO_SHORT", "short", "/coordinates/0", {{1.5, 2.5}}, {}},
                           {"TRIANGLE_FLAT", "flat", "", {}, 7}}};
    const auto errors = json::parse(write_problem(problem, "/", "id"))["errors"];
    ASSERT_EQ(errors.size(), 2U);
    EXPECT_EQ(errors[0], json({{"code", "RING_TOO_SHORT"},
                               {"detail", "short"},
                               {"pointer", "/coordinates/0"},
                               {"coordinate", {1.5, 2.5}}}));
    EXPECT_EQ(errors[1], json({{"code", "TRIANGLE_FLAT"}, {"detail", "flat"}, {"index", 7}}));
}

TEST(WriteProblem, WritesAHundredFaultsAtMost) {
    Problem problem{ProblemType::InvalidContent, "many", {}};
    for (int i = 0; i < 300; ++i)
        problem.errors.push_back({"X", "x", ""});
    EXPECT_EQ(json::parse(write_problem(problem, "/", "id"))["errors"].size(), kMaxFaults);
}

TEST(WriteProblem, SurvivesBytesThatAreNotUtf8) {
    const Problem problem{ProblemType::BadRequest, "\xff\xfe\"\n", {{"X", "\x80", "/\xc3"}}};
    EXPECT_TRUE(json::accept(write_problem(problem, "/\xff", "id")));
}

TEST(ProblemOfFaults, ChoosesTheStatusByKind) {
    const auto status = [](FaultKind kind) {
        return problem_status(problem_of_faults(kind, {{"X", "x", ""}}).type);
    };
    EXPECT_EQ(status(FaultKind::Syntax), 400);
    EXPECT_EQ(status(FaultKind::Invalid), 422);
    EXPECT_EQ(status(FaultKind::Unsupported), 422);
    EXPECT_EQ(status(FaultKind::TooLarge), 413);
    EXPECT_EQ(status(FaultKind::Parameter), 400);
}

TEST(ProblemOfErrors, KnowsEveryCodeOfTheCore) {
    using core::ErrorCode;
    const auto status = [](ErrorCode code) {
        return problem_status(problem_of_errors({{code, "x", {}}}, {{"X", "x", ""}}).type);
    };
    for (const auto code :
         {ErrorCode::CoordinateNotFinite, ErrorCode::CoordinateOutOfRange, ErrorCode::MeshEmpty,
          ErrorCode::VertexIndexOutOfRange, ErrorCode::TriangleFlat, ErrorCode::EdgeNotManifold,
          ErrorCode::VertexUnused, ErrorCode::RingTooShort, ErrorCode::LineTooShort,
          ErrorCode::ShapeEmpty, ErrorCode::OutsideMesh, ErrorCode::LeavesMesh,
          ErrorCode::NotRepresentable, ErrorCode::CrossingBudget, ErrorCode::TriangleBudget,
          ErrorCode::IdBudget}) {
        EXPECT_EQ(status(code), 422) << core::code_name(code);
    }
    EXPECT_EQ(status(ErrorCode::MeshTooLarge), 413);
    EXPECT_EQ(status(ErrorCode::Cancelled), 503);
    EXPECT_EQ(status(ErrorCode::StepBudget), 500);
}

TEST(ProblemOfStatus, FindsAProblemForWhatTheTransportRefuses) {
    for (const int status : {400, 404, 405, 411, 413, 414, 415, 416, 431, 500}) {
        EXPECT_EQ(problem_status(problem_of_status(status)), status);
    }
    EXPECT_EQ(problem_of_status(499), ProblemType::BadRequest);
    EXPECT_EQ(problem_of_status(599), ProblemType::Internal);
}

/// What the edge refuses by itself is said in the words that the server has for it.
TEST(Problems, AreTheSameAtTheEdge) {
    std::ifstream file(TINSMITH_SOURCE_DIR "/docker/haproxy.cfg");
    static const std::regex kAnswer(
        R"(\bstatus (\d+) content-type application/problem\+json .*'(\{.*\})')");
    static const std::regex kValue(R"(%\[[a-z_().]*\])");
    int count = 0;
    for (std::string line; std::getline(file, line);) {
        std::smatch match;
        if (line.find("urn:tinsmith:problem:") == std::string::npos) continue;
        ++count;
        ASSERT_TRUE(std::regex_search(line, match, kAnswer)) << line;
        const int status = std::stoi(match[1]);
        const json problem = json::parse(std::regex_replace(match[2].str(), kValue, "x"));
        const std::string word = problem["type"].get<std::string>().substr(21);
        const auto types = all_problems();
        const auto type = std::find_if(types.begin(), types.end(), [&word](ProblemType one) {
            return problem_word(one) == word;
        });
        ASSERT_NE(type, types.end()) << word;
        EXPECT_EQ(problem["status"], status) << line;
        // A server that does not answer has failed; HTTP has its own statuses for that.
        EXPECT_EQ(status == 502 || status == 504 ? 500 : status, problem_status(*type)) << line;
        EXPECT_EQ(problem["title"], problem_title(*type));
        const Problem same{*type, problem["detail"], {}};
        json written = json::parse(write_problem(same, "x", "x"));
        written["status"] = status;
        EXPECT_EQ(problem, written);
    }
    EXPECT_GE(count, 10);
}

}  // namespace
}  // namespace tinsmith::api
