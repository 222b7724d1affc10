// SPDX-License-Identifier: Apache-2.0
// Replays every file of tests/cases: each was a bug once, each request must keep all guarantees.
// Those in tests/cases/open still fail; shrink_case writes them.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/laws.hpp"
#include "tests/support/trial.hpp"

namespace tinsmith {
namespace {

std::vector<std::string> files_in(const std::string& folder) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".txt") found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    return found;
}

const std::string kCases = std::string(TINSMITH_SOURCE_DIR) + "/tests/cases";

class CaseFile : public testing::TestWithParam<std::string> {};

TEST_P(CaseFile, KeepsAllGuarantees) {
    const test::Case replayed = test::read_case_file(GetParam());
    EXPECT_FALSE(replayed.requests.empty());
    const test::Verdict verdict = test::replay(replayed);
    for (const std::string& fault : verdict.broken)
        ADD_FAILURE() << GetParam() << ": " << fault;
}

TEST_P(CaseFile, KeepsTheLawsBetweenTwoIntegrations) {
    const test::Case replayed = test::read_case_file(GetParam());
    const test::Trial trial(replayed.mesh);
    for (const std::string& fault : test::check_laws(trial.tin(), replayed.requests.front()))
        ADD_FAILURE() << GetParam() << ": " << fault;
}

TEST_P(CaseFile, ReadsAsItIsWritten) {
    const std::string once = test::case_text(test::read_case_file(GetParam()));
    std::istringstream in(once);
    EXPECT_EQ(test::case_text(test::read_case(in)), once);
}

std::string case_name(const testing::TestParamInfo<std::string>& info) {
    return std::filesystem::path(info.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Cases, CaseFile, testing::ValuesIn(files_in(kCases)), case_name);

TEST(CaseText, AFaultyLineIsNamed) {
    for (const std::string line : {"vertex 1 2", "triangle 0 1 x", "point 1 2", "request fast",
                                   "vertex 1 2 3 4", "nonsense"}) {
        std::istringstream in("# a note\n" + line + "\n");
        try {
            test::read_case(in);
            ADD_FAILURE() << line << " was read";
        } catch (const std::runtime_error& fault) {
            EXPECT_EQ(std::string(fault.what()).substr(0, 7), "line 2:") << line;
        }
    }
}

}  // namespace
}  // namespace tinsmith
