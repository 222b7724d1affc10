// SPDX-License-Identifier: Apache-2.0
// JSON that is deep, ambiguous or out of range: each route that takes JSON refuses it in the same
// words, at its place.
#include <string>
#include <vector>

#include "api/formats/json_reader.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

struct Target {
    std::string method;
    std::string path;
};

const std::vector<Target> kTargets{{"POST", "/v1/sessions"},
                                   {"PUT", "/v1/sessions/other"},
                                   {"POST", "/v1/sessions/s/polygons"},
                                   {"POST", "/v1/sessions/s/edits"},
                                   {"POST", "/v1/sessions/s/elevation"},
                                   {"POST", "/v1/sessions/s/profile"},
                                   {"POST", "/v1/sessions/s/volume"},
                                   {"PUT", "/v1/sessions/s/locks"},
                                   {"DELETE", "/v1/sessions/s/locks"}};

class HostileJson : public Handlers {
  protected:
    void SetUp() override {
        ASSERT_EQ(ask("PUT", "/v1/sessions/s", {{"content-type", "application/json"}},
                      R"({"grid": {"origin": [0,0], "cell": [10,10], "columns": 2, "rows": 2,
                          "elevations": [1,2,3,4]}})")
                      .status,
                  201);
    }

    /// Somewhere in its answers is this fault.
    void expect_everywhere(const std::string& body, int status, const std::string& code,
                           const std::string& pointer) {
        for (const auto& [method, path] : kTargets) {
            SCOPED_TRACE(method + " " + path + " " + body.substr(0, 60));
            const Response answer = ask(method, path, {{"content-type", "application/json"}}, body);
            EXPECT_EQ(answer.status, status) << answer.body;
            bool is_told = false;
            const json problem = json::parse(answer.body);
            for (const auto& fault : problem["errors"])
                is_told |= fault["code"] == code && fault.value("pointer", "") == pointer;
            EXPECT_TRUE(is_told) << code << " at " << pointer << ": " << answer.body;
        }
    }
};

TEST_F(HostileJson, IsAtMostThirtyTwoDeep) {
    std::string deep;
    std::string pointer;
    for (int i = 0; i < 31; ++i) {
        deep += "[";
        pointer += "/0";
    }
    expect_everywhere(R"({"a": )" + deep + "[", 400, "JSON_TOO_DEEP", "/a" + pointer);
}

TEST_F(HostileJson, HasEachNameOnce) {
    expect_everywhere(R"({"a": 1, "a": 2})", 422, "MEMBER_REPEATED", "/a");
    expect_everywhere(R"({"b": [{"a": {"c": 1, "d": 2, "c": 3}}]})", 422, "MEMBER_REPEATED",
                      "/b/0/a/c");
    expect_everywhere(R"({"type": "Point", "type": "Polygon"})", 422, "MEMBER_REPEATED", "/type");
}

TEST_F(HostileJson, HasNumbersThatDoublesHold) {
    expect_everywhere(R"({"a": [1, 1e999]})", 422, "NUMBER_OUT_OF_RANGE", "/a/1");
    expect_everywhere(R"({"a": [1, -1e999]})", 422, "NUMBER_OUT_OF_RANGE", "/a/1");
    expect_everywhere(R"({"a": [NaN]})", 400, "JSON_SYNTAX", "");
    expect_everywhere(R"({"a": -Infinity})", 400, "JSON_SYNTAX", "");
    expect_everywhere(R"({"a": )" + std::string(api::json::kLongestNumber + 1, '0') + "}", 422,
                      "NUMBER_TOO_LONG", "/a");
}

TEST_F(HostileJson, HasTextsThatPeopleRead) {
    const std::string text(api::json::kLongestText + 1, 'x');
    expect_everywhere(R"({"a": [")" + text + "\"]}", 422, "TEXT_TOO_LONG", "/a/0");
    expect_everywhere(R"({"b": {")" + text + "\": 1}}", 422, "TEXT_TOO_LONG", "/b");
}

TEST_F(HostileJson, HasNoCoordinateThatIsNearlyZero) {
    const std::string line = R"({"type": "LineString", "coordinates": [[1, 1], [1e-999, 2]]})";
    for (const char* path : {"/v1/sessions/s/polygons", "/v1/sessions/s/profile"}) {
        const Response answer = ask("POST", path, {{"content-type", "application/json"}}, line);
        EXPECT_EQ(answer.status, 422);
        EXPECT_EQ(told(answer), "COORDINATE_OUT_OF_RANGE");
    }
    EXPECT_EQ(told(ask("POST", "/v1/sessions", {{"content-type", "application/json"}},
                       R"({"points": [[0,0,0],[1,0,-1e-999],[0,1,0]]})")),
              "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(told(ask("POST", "/v1/sessions", {{"content-type", "application/json"}},
                       R"({"mesh": {"vertices": [[0,0,0],[1,0,0],[0,1,0]],
                           "triangles": [[0,1,9007199254740994]]}})")),
              "INDEX_INVALID");
}

}  // namespace
}  // namespace tinsmith::server
