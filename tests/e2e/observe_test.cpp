// SPDX-License-Identifier: Apache-2.0
// What the binary tells of itself: figures for Prometheus and a log that nobody can forge.
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"
#include "tests/support/prometheus_text.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;
using testing_support::PrometheusText;

const std::string kJson = "Content-Type: application/json";
const std::string kSquare =
    R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                 "triangles": [[0,1,2],[0,2,3]]}})";
const std::string kParcel =
    R"({"type": "Polygon", "coordinates": [[[1,2],[5,2],[5,7],[1,7],[1,2]]]})";

PrometheusText scrape(int port) {
    const Answer answer = ask(port, "GET", "/metrics");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.header("content-type"), "text/plain; version=0.0.4; charset=utf-8");
    PrometheusText text(answer.body);
    EXPECT_EQ(text.faults(), "");
    return text;
}

TEST(Observe, FiguresFollowWhatIsAsked) {
    ServerUnderTest server;
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::string session =
        ask(server.port(), "POST", "/v1/sessions", {kJson}, kSquare).header("location");
    const PrometheusText before = scrape(server.port());
    const Answer cut = ask(server.port(), "POST", session + "/polygons", {kJson}, kParcel);
    ASSERT_EQ(cut.status, 200) << cut.body;
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(ask(server.port(), "GET", session + "/mesh.glb").status, 200);
    const Answer head = ask(server.port(), "HEAD", session + "/mesh.glb");
    const PrometheusText after = scrape(server.port());
    const auto grown = [&](const std::string& series) {
        return after.value(series) -
               (std::isnan(before.value(series)) ? 0.0 : before.value(series));
    };
    const json totals = json::parse(cut.body)["totals"];
    EXPECT_EQ(grown("tinsmith_crossings_total"), totals["crossings"]);
    EXPECT_GT(totals["crossings"], 0);
    EXPECT_EQ(grown("tinsmith_vertices_added_total"), totals["vertices_added"]);
    EXPECT_EQ(grown(R"(tinsmith_edits_total{sort="polygons"})"), 1);
    EXPECT_EQ(grown("tinsmith_mesh_cache_misses_total"), 1);
    EXPECT_EQ(grown("tinsmith_mesh_cache_hits_total"), 3);
    const std::string count = "tinsmith_http_request_seconds_count";
    const std::string mesh = R"(",route="/v1/sessions/{id}/mesh.glb",status="200"})";
    EXPECT_EQ(grown(count + R"({method="GET)" + mesh), 3);
    EXPECT_EQ(grown(count + R"({method="HEAD)" + mesh), 1);
    EXPECT_EQ(grown(count + R"({method="POST",route="/v1/sessions/{id}/polygons",status="200"})"),
              1);
    EXPECT_GE(grown("tinsmith_http_request_bytes_total"), static_cast<double>(kParcel.size()));
    EXPECT_EQ(after.value("tinsmith_sessions"), 1);
    EXPECT_EQ(after.value("tinsmith_http_requests_in_flight"), 1) << "the scrape itself";
    EXPECT_GE(after.value("tinsmith_http_connections"), 1);
    EXPECT_EQ(after.value("tinsmith_http_connections_sent_away_total"), 0);
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(server.stop(), "");
}

/// Targets that nobody serves, names of sessions that are not there, methods that are none.
TEST(Observe, TenThousandPathsMakeNoSeries) {
    ServerUnderTest server({"--log-level", "error"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::vector<std::string> kinds{"/", "/v1/sessions/", "/v1/", "/metrics/", "/viewer/"};
    const auto storm = [&](int from, int until) {
        auto client = std::make_unique<Connection>(server.port());
        for (int i = from; i < until; ++i) {
            const std::string target = kinds[static_cast<std::size_t>(i) % kinds.size()] +
                                       std::to_string(i * 7919) + (i % 3 == 0 ? "/mesh.glb" : "");
            client->send(request_text(i % 4 == 0 ? "DELETE" : "GET", target));
            const Answer answer = client->read();
            ASSERT_TRUE(answer.status == 404 || answer.status == 405) << target;
            // The server ends a connection after its thousandth request.
            if (answer.header("connection") == "close")
                client = std::make_unique<Connection>(server.port());
        }
    };
    storm(0, 100);
    for (const char* method : {"BREW", "get", "PROPFIND"})
        ask(server.port(), method, "/x");
    const PrometheusText before = scrape(server.port());
    storm(100, 10'100);
    for (int i = 0; i < 50; ++i)
        ask(server.port(), "M" + std::to_string(i), "/x");
    const PrometheusText after = scrape(server.port());
    EXPECT_EQ(after.count("tinsmith_http_request_seconds_count"),
              before.count("tinsmith_http_request_seconds_count") + 1)
        << "that of the first scrape alone is new";
    EXPECT_LT(after.count(), 1000U);
    EXPECT_GT(after.value(R"(tinsmith_http_request_seconds_count{method="GET",)"
                          R"(route="none",status="404"})"),
              1000);
    EXPECT_EQ(server.stop(), "");
}

TEST(Observe, NoRequestForgesALineOfTheLog) {
    ServerUnderTest server({"--log-level", "debug"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const std::string forged = "{\"level\":\"error\",\"event\":\"forged\"}";
    const std::string nul("\0", 1);
    const std::vector<std::string> texts{"\",\"event\":\"forged\",\"x\":\"",
                                         "%0d%0a" + forged,
                                         "\r" + forged,
                                         "\xe2\x80\xa8" + forged + "\xe2\x80\xa9",
                                         "\xff\xfe\x80",
                                         "\\\"\\",
                                         nul + forged,
                                         "\x1b[2J\x07\x7f",
                                         std::string(10'000, 'a'),
                                         std::string(400, '%')};
    std::size_t sent = 0;
    for (const std::string& text : texts) {
        for (const std::string& request :
             {"GET /" + text + " HTTP/1.1\r\nHost: x\r\n\r\n",
              "GET /v1/sessions?q=" + text + " HTTP/1.1\r\nHost: x\r\n\r\n",
              "GET /v1/sessions/" + text + "/mesh HTTP/1.1\r\nHost: x\r\n\r\n",
              "GET /x HTTP/1.1\r\nHost: " + text + "\r\nX-Request-Id: " + text +
                  "\r\ntraceparent: " + text + "\r\nUser-Agent: " + text + "\r\n\r\n",
              "DELETE" + text + " /x HTTP/1.1\r\nHost: x\r\n\r\n",
              "POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: " + text +
                  "\r\nIdempotency-Key: " + text + "\r\nContent-Length: 0\r\n\r\n"}) {
            Connection client(server.port());
            client.send(request);
            if (client.read().status != 0) ++sent;
        }
    }
    server.program().send_signal(SIGTERM);
    EXPECT_EQ(server.program().wait(), 0);
    std::size_t requests = 0;
    std::istringstream log(server.program().output());
    for (std::string line; std::getline(log, line);) {
        const json event = json::parse(line, nullptr, false);
        ASSERT_TRUE(event.is_object()) << line;
        EXPECT_NE(event["event"], "forged") << line;
        EXPECT_LT(line.size(), 8000U);
        for (const char c : line)
            ASSERT_TRUE(c >= 0x20 && c < 0x7f) << line;
        if (event["event"] != "request") continue;
        for (const char* member : {"time", "level", "method", "path", "status", "bytes", "bytes_in",
                                   "ms", "request", "client"})
            EXPECT_TRUE(event.contains(member)) << member << " in " << line;
        EXPECT_EQ(event.contains("problem"), event["status"] >= 400) << line;
        if (event["path"] != "/readyz") ++requests;
    }
    EXPECT_GE(sent, 4 * texts.size());
    EXPECT_EQ(requests, sent) << "a line for each answer";
}

TEST(Observe, SpeaksTextWhereItIsAskedTo) {
    ServerUnderTest server({"--log-format", "text"});
    ASSERT_NE(server.port(), 0) << server.program().output();
    EXPECT_EQ(ask(server.port(), "GET", "/v1/limits").status, 200);
    const std::string log = server.program().output();
    EXPECT_NE(log.find(" info serving on http://127.0.0.1:"), std::string::npos) << log;
    EXPECT_NE(log.find(" info GET \"/v1/limits\" status=200 bytes="), std::string::npos) << log;
}

TEST(Observe, AlertsUseRealNames) {
    ScratchDirectory scratch;
    ServerUnderTest server({"--data", scratch.file("data")});
    ASSERT_NE(server.port(), 0) << server.program().output();
    const PrometheusText text = scrape(server.port());
    const std::string page = content_of(std::string(TINSMITH_SOURCE_DIR) + "/docker/README.md");
    const std::regex name(R"(\b(tinsmith|process)_[a-z_]+)");
    std::size_t names = 0, alerts = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), name), end; at != end; ++at, ++names)
        EXPECT_TRUE(text.has(at->str()) || text.has(at->str() + "_count")) << at->str();
    const std::regex alert("- alert: [A-Z]");
    for (std::sregex_iterator at(page.begin(), page.end(), alert), end; at != end; ++at)
        ++alerts;
    EXPECT_GE(alerts, 5U);
    EXPECT_GE(names, 10U);
    EXPECT_EQ(server.stop(), "");
}

std::set<std::string> words_in(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    std::set<std::string> words;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
        words.insert((*at)[1].str());
    return words;
}

TEST(Observe, EventsAreThoseOfThePage) {
    const std::string root = TINSMITH_SOURCE_DIR;
    std::set<std::string> logged;
    for (const auto& file : std::filesystem::recursive_directory_iterator(root + "/server")) {
        if (file.path().extension() != ".cpp") continue;
        logged.merge(
            words_in(content_of(file.path().string()), R"re(log_event\([^";]*"([a-z_]+)")re"));
    }
    logged.insert("request");  // by log_request
    const std::string page = content_of(root + "/docker/README.md");
    const std::size_t table = page.find("| `event` |"), after = page.find("\n\n", table);
    ASSERT_NE(after, std::string::npos);
    std::set<std::string> told;
    for (const std::string& cell :
         words_in(page.substr(table, after - table), R"re(\n\| (`[a-z_`, ]+`) \|)re"))
        told.merge(words_in(cell, "`([a-z_]+)`"));
    EXPECT_EQ(logged, told);
    for (const std::string& word : words_in(page, R"re(event=\\?"([a-z_]+))re"))
        EXPECT_TRUE(told.contains(word)) << word;
}

}  // namespace
}  // namespace tinsmith::e2e
