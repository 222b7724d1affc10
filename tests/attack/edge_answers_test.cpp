// SPDX-License-Identifier: Apache-2.0
// What HAProxy answers by itself where the server behind it does not, or the client sends no body.
#include <cstdlib>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/attack/bad_server.hpp"
#include "tests/attack/edge_problem.hpp"
#include "tests/attack/proxy.hpp"

namespace tinsmith::e2e {
namespace {

class EdgeAlone : public testing::Test {
  protected:
    void SetUp() override {
        if (Proxy::program().empty())
            GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
        // The same, but for the time that a test has.
        proxy_.emplace(server_.port(),
                       Proxy::Changes{{"timeout server 90s", "timeout server 1s"},
                                      {"wait-for-body time 5s", "wait-for-body time 1s"}});
        ASSERT_NE(proxy_->port(), 0) << proxy_->output();
    }

    Answer get(const std::string& path) const {
        return ask(proxy_->port(), "GET", path, {"X-Request-Id: mine-1"});
    }

    BadServer server_;
    std::optional<Proxy> proxy_;
};

TEST_F(EdgeAlone, TellsOfAServerThatFails) {
    expect_problem(get("/v1/closes"), 502, "internal", "/v1/closes");
    expect_problem(get("/v1/babbles"), 502, "internal", "/v1/babbles");
    const Answer answer = get("/v1/hangs?a=b");
    expect_problem(answer, 504, "internal", "/v1/hangs");
    EXPECT_EQ(answer.header("x-request-id"), "mine-1");
    EXPECT_EQ(get("/v1/works").status, 200);
}

TEST_F(EdgeAlone, TellsOfAServerThatIsGone) {
    server_.stop();
    const Answer answer = get("/v1/limits");
    expect_problem(answer, 503, "not-ready", "/v1/limits");
    EXPECT_NE(answer.header("retry-after"), "");
}

TEST_F(EdgeAlone, TellsOfABodyThatDoesNotCome) {
    Connection client(proxy_->port());
    client.send("POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\n{");
    expect_problem(client.read(), 408, "request-timeout", "/v1/sessions");
}

/// Whatever the path is, the answer is JSON.
TEST_F(EdgeAlone, WritesPathsAsTheyMayStand) {
    const std::string path = R"(/v1/%22\")"
                             "\xc3\xa4"
                             R"({},)";
    for (const std::string& target : {path, "/" + std::string(5000, 'a')}) {
        Connection client(proxy_->port());
        client.send("GET " + target + " HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
        const Answer answer = client.read();
        if (answer.status == 400) continue;  // newer ones refuse such bytes by themselves
        expect_problem(answer, 411, "length-required", target.substr(0, 512));
    }
}

TEST(EdgeConfiguration, IsOneWithoutAWarning) {
    if (Proxy::program().empty())
        GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
    const ScratchDirectory scratch;
    const std::string output = scratch.file("output");
    const std::string command =
        "TINSMITH_EDGE_PORT=1 TINSMITH_SERVER=127.0.0.1:2 " + Proxy::program() +
        " -c -f " TINSMITH_SOURCE_DIR "/docker/haproxy.cfg >" + output + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << content_of(output);
    for (const char* complaint : {"WARNING", "ALERT", "NOTICE"})
        EXPECT_EQ(content_of(output).find(complaint), std::string::npos) << content_of(output);
}

}  // namespace
}  // namespace tinsmith::e2e
