// SPDX-License-Identifier: Apache-2.0
#include "server/log.hpp"

#include <functional>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tinsmith::server {
namespace {

using nlohmann::json;

/// What clients may try: to end a line or a text, to begin another, to be no text at all.
const std::vector<std::string>& hostile_texts() {
    static const std::vector<std::string> kTexts{
        "a\r\n{\"event\":\"stopped\"}",
        "\",\"event\":\"stopped\",\"x\":\"",
        "back\\slash\\",
        std::string("nul\0nul", 7),
        "\x1b[31mred\x1b[0m",
        "line\xe2\x80\xa8separator\xe2\x80\xa9paragraph\xc2\x85next",
        "\xff\xfe\x80 no UTF-8",
        "\xc0\xaf long form",
        "\xed\xa0\x80 half of a pair",
        "\xf4\x90\x80\x80 beyond Unicode",
        "cut \xe2\x80",
        "\xf0\x9f\x8c\x8d earth",
        std::string(10'000, 'a'),
        std::string(599, 'a') + "\xe2\x80\xa8",
        ""};
    return kTexts;
}

json parsed(const std::string& members) {
    EXPECT_EQ(members.find_first_of("\r\n"), std::string::npos);
    for (const char c : members)
        EXPECT_TRUE(c >= 0x20 && c < 0x7f) << static_cast<int>(c);
    return json::parse("{" + members + "}", nullptr, false);
}

TEST(LogLine, IsOneObjectWhateverItTells) {
    for (const std::string& text : hostile_texts()) {
        const std::vector<LogField> fields{{"event", "request"}, {"path", text}, {"last", 1}};
        const json line = parsed(json_members(fields));
        ASSERT_TRUE(line.is_object()) << text;
        EXPECT_EQ(line.size(), 3U) << text;
        EXPECT_EQ(line["event"], "request");
        EXPECT_EQ(line["last"], 1);
    }
}

TEST(LogLine, KeepsWhatIsText) {
    const auto back = [](const std::string& text) {
        const std::vector<LogField> fields{{"a", text}};
        return parsed(json_members(fields))["a"].get<std::string>();
    };
    for (const std::string text : {"plain", "\"quoted\"\\", "\r\n\t", "\xe2\x80\xa8", "\xc3\xbc",
                                   "\xf0\x9f\x8c\x8d", "\x7f"}) {
        EXPECT_EQ(back(text), text);
    }
    EXPECT_EQ(back("a\xff"
                   "b"),
              "a\xef\xbf\xbd"
              "b");
    EXPECT_EQ(back("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    EXPECT_EQ(back("\xe2\x80"), "\xef\xbf\xbd\xef\xbf\xbd");
    EXPECT_EQ(back(std::string(10'000, 'a')), std::string(kLongestLogText, 'a') + "...");
}

TEST(LogLine, WritesNumbersPlainly) {
    const std::vector<LogField> fields{
        {"ms", 1.23456}, {"big", 1e15}, {"bytes", std::size_t{7}}, {"nan", 0.0 / 0.0}};
    EXPECT_EQ(json_members(fields),
              R"("ms":1.235,"big":1000000000000000.000,"bytes":7,"nan":null)");
}

TEST(LogLine, IsOneLineForPeopleToo) {
    for (const std::string& text : hostile_texts()) {
        const std::vector<LogField> fields{{"path", text}, {"last", 1}};
        const std::string line = text_members(fields);
        for (const char c : line)
            EXPECT_TRUE(c >= 0x20 && c < 0x7f) << static_cast<int>(c);
        EXPECT_TRUE(line.ends_with(" last=1")) << line;
    }
    const std::vector<LogField> fields{{"why", "a b=\"c"}, {"id", "x"}};
    EXPECT_EQ(text_members(fields), R"( why="a b=\x22c" id=x)");
}

TEST(Sanitized, LeavesNoWayToForgeALine) {
    EXPECT_EQ(sanitized("/v1/a b"), "/v1/a b");
    EXPECT_EQ(sanitized("a\nb\r\x1b[31m\"\\\x7f\xff"), "a\\x0ab\\x0d\\x1b[31m\\x22\\x5c\\x7f\\xff");
    EXPECT_EQ(sanitized(std::string(300, 'a')), std::string(200, 'a') + "...");
}

/// What the logger writes to standard error meanwhile, line by line.
std::vector<json> logged(const std::function<void()>& what) {
    set_log_format(LogFormat::Json);
    testing::internal::CaptureStderr();
    what();
    std::istringstream text(testing::internal::GetCapturedStderr());
    set_log_format(LogFormat::Text);
    std::vector<json> lines;
    for (std::string line; std::getline(text, line);)
        lines.push_back(json::parse(line, nullptr, false));
    return lines;
}

TEST(Log, TellsRequestsWithAllThatIsKnownOfThem) {
    Request request;
    request.method = "GET";
    request.path = "/v1/sessions/a";
    request.body = "12345";
    request.id = "my-id";
    request.remote_address = "127.0.0.1";
    request.trace = parse_traceparent("00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01");
    Response response;
    response.body = "1234567";
    const auto lines = logged([&] {
        log_request(request, response, 1.5);
        request.method = "HEAD";
        response.problem = "not-ready";
        request.asker.name = "a\n\"b";  // the file of keys refuses such names
        log_request(request, response, 1.5);
    });
    ASSERT_EQ(lines.size(), 2U);
    const json& line = lines[0];
    EXPECT_EQ(line["level"], "info");
    EXPECT_EQ(line["event"], "request");
    EXPECT_EQ(line["method"], "GET");
    EXPECT_EQ(line["path"], "/v1/sessions/a");
    EXPECT_EQ(line["status"], 200);
    EXPECT_EQ(line["bytes"], 7);
    EXPECT_EQ(line["bytes_in"], 5);
    EXPECT_EQ(line["ms"], 1.5);
    EXPECT_EQ(line["request"], "my-id");
    EXPECT_EQ(line["client"], "127.0.0.1");
    EXPECT_EQ(line["trace"], "0af7651916cd43dd8448eb211c80319c");
    EXPECT_EQ(line["time"].get<std::string>().size(), 29U) << line["time"];
    EXPECT_FALSE(line.contains("problem"));
    EXPECT_FALSE(line.contains("key"));
    EXPECT_EQ(lines[1]["key"], "a\n\"b") << "within its quotes";
    EXPECT_EQ(lines[1]["bytes"], 0) << "HEAD has no body";
    EXPECT_EQ(lines[1]["problem"], "not-ready");
}

TEST(Log, TellsFailuresByTheirLevelAndProbesQuietly) {
    const auto level = [](const std::string& path, int status) {
        Request request;
        request.path = path;
        Response response;
        response.status = status;
        const auto lines = logged([&] { log_request(request, response, 0.0); });
        return lines.empty() ? "quiet" : lines[0]["level"].get<std::string>();
    };
    set_log_level(LogLevel::Info);
    EXPECT_EQ(level("/v1/sessions", 200), "info");
    EXPECT_EQ(level("/v1/sessions", 404), "info");
    EXPECT_EQ(level("/v1/sessions", 503), "warning");
    EXPECT_EQ(level("/v1/sessions", 507), "warning");
    EXPECT_EQ(level("/v1/sessions", 500), "error");
    EXPECT_EQ(level("/metrics", 500), "error");
    EXPECT_EQ(level("/metrics", 200), "quiet");
    EXPECT_EQ(level("/healthz", 200), "quiet");
    EXPECT_EQ(level("/readyz", 503), "quiet");
    set_log_level(LogLevel::Debug);
    EXPECT_EQ(level("/healthz", 200), "debug");
    set_log_level(LogLevel::Info);
}

}  // namespace
}  // namespace tinsmith::server
