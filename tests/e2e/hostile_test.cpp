// SPDX-License-Identifier: Apache-2.0
// Requests on which two ends could disagree where they end, or which cost more than they bring.
#include <memory>

#include <gtest/gtest.h>

#include "tests/e2e/program.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

class Hostile : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        server = new ServerUnderTest({"--max-body-bytes", "1000000"});
        ASSERT_NE(server->port(), 0) << server->program().output();
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(server->stop(), "");
        delete server;
        server = nullptr;
    }

    /// Sends the bytes and expects one problem of that status and the end of the connection: what
    /// else was in the bytes must not be taken for a request.
    static void expect_refused(const std::string& bytes, int status) {
        SCOPED_TRACE(bytes.substr(0, 200));
        Connection connection(server->port());
        connection.send(bytes);
        const Answer answer = connection.read();
        EXPECT_EQ(answer.status, status) << answer.body;
        EXPECT_EQ(answer.header("content-type"), "application/problem+json");
        EXPECT_NE(answer.header("x-request-id"), "");
        EXPECT_TRUE(connection.is_closed());
        EXPECT_EQ(ask(server->port(), "GET", "/healthz").status, 200);
    }

    static std::string post(const std::string& headers, const std::string& body = {}) {
        return "POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n" +
               headers + "\r\n" + body;
    }
    static std::string get(const std::string& headers, const std::string& body = {}) {
        return "GET /healthz HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n" + body;
    }

    static inline const std::string smuggled = "GET /v1/sessions HTTP/1.1\r\nHost: x\r\n\r\n";
    static inline ServerUnderTest* server = nullptr;
};

TEST_F(Hostile, ChunkedBodies) {
    const std::string chunks = "5\r\nhello\r\n0\r\n\r\n";
    expect_refused(post("Transfer-Encoding: chunked\r\n", chunks), 411);
    expect_refused(post("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", chunks), 411);
    expect_refused(post("transfer-encoding:\tchunked\r\n", chunks), 411);
}

TEST_F(Hostile, LengthsThatAreNone) {
    expect_refused(post("Content-Length: abc\r\n", "x"), 400);
    expect_refused(post("Content-Length: -1\r\n", "x"), 400);
    expect_refused(post("Content-Length: 0x5\r\n", "hello"), 400);
    expect_refused(post("Content-Length: 99999999999999999999\r\n", "x"), 400);
    expect_refused(post("Content-Length: 1\r\nContent-Length: 5\r\n", "hello"), 400);
}

TEST_F(Hostile, NamesThatOthersReadAsTheLength) {
    const std::string length = std::to_string(smuggled.size());
    for (const std::string& header :
         {"Content-Length : " + length, "Content-Length\t: " + length,
          "X-Folded: 1\r\n Content-Length: " + length, std::string("Transfer-Encoding : chunked"),
          "Content-Length" + std::string(1, '\0') + ": " + length, "Content Length: " + length})
        expect_refused(post(header + "\r\n", smuggled), 400);
}

TEST_F(Hostile, RequestsForNoHost) {
    expect_refused("GET /v1/limits HTTP/1.1\r\n\r\n", 400);
}

TEST_F(Hostile, BodiesWhereNoneBelong) {
    expect_refused(get("Content-Length: " + std::to_string(smuggled.size()) + "\r\n", smuggled),
                   400);
    expect_refused("HEAD /healthz HTTP/1.1\r\nHost: x\r\nContent-Length: " +
                       std::to_string(smuggled.size()) + "\r\n\r\n" + smuggled,
                   400);
}

TEST_F(Hostile, BodiesThatAreTooLarge) {
    expect_refused(post("Content-Length: 1000001\r\n"), 413);
    expect_refused(post("Content-Length: 1000001\r\nExpect: 100-continue\r\n"), 413);
    expect_refused(post("Content-Length: 5000000\r\n", std::string(5'000'000, 'x')), 413);
    expect_refused(post("Content-Length: 5\r\nContent-Encoding: gzip\r\n", "hello"), 415);
}

TEST_F(Hostile, BodiesThatEndEarly) {
    Connection connection(server->port());
    connection.send(post("Content-Length: 500\r\n", "{"));
    connection.end_sending();
    // Older versions of the library do not answer a client that has closed its side.
    const int status = connection.read().status;
    EXPECT_TRUE(status == 400 || status == 0) << status;
    EXPECT_TRUE(connection.is_closed());
    EXPECT_EQ(ask(server->port(), "GET", "/healthz").status, 200);
}

TEST_F(Hostile, Invitations) {
    Connection connection(server->port());
    connection.send(post("Content-Length: 2\r\nExpect: 100-continue\r\n"));
    EXPECT_EQ(connection.read().status, 100);
    connection.send("{}");
    EXPECT_EQ(connection.read().status, 422);
    connection.send(post("Content-Length: 2\r\nExpect: 100-Continue\r\n"));
    EXPECT_EQ(connection.read().status, 100) << "in any case";
    connection.send("{}");
    EXPECT_EQ(connection.read().status, 422);
    // Nothing is to come.
    connection.send(post("Content-Length: 0\r\nExpect: 100-continue\r\n"));
    EXPECT_EQ(connection.read().status, 400);
    connection.send(get("Expect: 100-continue\r\n"));
    EXPECT_EQ(connection.read().status, 200);
}

/// What the head tells is answered before the body comes, and instead of an invitation.
TEST_F(Hostile, BodiesForNobody) {
    const auto head = [](const std::string& line, const std::string& headers) {
        return line + " HTTP/1.1\r\nHost: x\r\nContent-Length: 900000\r\n" + headers + "\r\n";
    };
    for (const std::string headers : {"", "Expect: 100-continue\r\n"}) {
        expect_refused(head("POST /nope", headers), 404);
        expect_refused(head("PUT /v1/sessions/a/polygons", headers), 405);
        expect_refused(head("POST /v1/sessions?colour=red", headers), 400);
    }
    // One that has no body left on it may go on.
    Connection connection(server->port());
    connection.send(request_text("POST", "/nope"));
    EXPECT_EQ(connection.read().status, 404);
    connection.send(request_text("GET", "/healthz"));
    EXPECT_EQ(connection.read().status, 200);
}

/// RFC 9110 14.2: a unit that is not known is no reason to refuse.
TEST_F(Hostile, RangesOfOtherUnits) {
    for (const std::string range : {"items=0-5", "items=0-1,2-3", "bytes 0-5", "x", ""}) {
        Connection connection(server->port());
        for (int i = 0; i < 2; ++i)
            connection.send(get("Range: " + range + "\r\nX: y\r\nrange: " + range + "\r\n"));
        EXPECT_EQ(connection.read().status, 200) << range;
        EXPECT_EQ(connection.read().status, 200) << range;
    }
    expect_refused(get("Range: items=0-5\r\nRange: bytes=0-1,2-3\r\n"), 416);
    Connection connection(server->port());
    connection.send(get("Range: bytes=x\r\n"));
    const Answer answer = connection.read();
    EXPECT_EQ(answer.status, 416);
    EXPECT_NE(answer.body.find("Ask for one range"), std::string::npos) << answer.body;
}

TEST_F(Hostile, LongLinesAreTold) {
    const auto told = [](const std::string& bytes) {
        Connection connection(server->port());
        connection.send(bytes);
        return connection.read();
    };
    const Answer query = told(request_text("GET", "/healthz?a=" + std::string(9000, 'a')));
    EXPECT_EQ(query.status, 414);
    EXPECT_NE(query.body.find("query, is longer than 8190 bytes"), std::string::npos) << query.body;
    EXPECT_NE(query.body.find("\"instance\":\"/healthz\""), std::string::npos) << query.body;
    const Answer header = told(get("X-Long: " + std::string(9000, 'a') + "\r\n"));
    EXPECT_EQ(header.status, 431);
    EXPECT_NE(header.body.find("X-Long is longer than 8190 bytes"), std::string::npos)
        << header.body;
}

/// RFC 9110 10.1.1: HTTP/1.0 has no invitations.
TEST_F(Hostile, InvitationsOfAnOlderTime) {
    for (const std::string version : {"1.1", "1.0"}) {
        Connection connection(server->port());
        std::string request = post("Content-Length: 2\r\nExpect: 100-continue\r\n", "{}");
        request.replace(request.find("1.1"), 3, version);
        connection.send(request);
        if (version == "1.1") {
            EXPECT_EQ(connection.read().status, 100);
        }
        EXPECT_EQ(connection.read().status, 422) << version;
    }
}

TEST_F(Hostile, OtherExpectations) {
    expect_refused(post("Content-Length: 2\r\nExpect: a-miracle\r\n"), 417);
    expect_refused(post("Content-Length: 2\r\nExpect: 100-continue, a-miracle\r\n"), 417);
    expect_refused(get("Expect: a-miracle\r\n"), 417);
}

TEST_F(Hostile, Headers) {
    const auto headers = [](int count) {
        std::string many;
        for (int i = 0; i < count; ++i)
            many += "X-" + std::to_string(i) + ": y\r\n";
        return many;
    };
    expect_refused(get(headers(95)), 431);
    expect_refused(get(headers(200)), 431);
    expect_refused(get("Range: bytes=0-1,2-3\r\n"), 416);
    expect_refused(get("REMOTE_ADDR: 10.0.0.1\r\n"), 400);
    expect_refused(get("Host: y\r\n"), 400);
    expect_refused(get("X-Long: " + std::string(10'000, 'a') + "\r\n"), 431);
    expect_refused(get("X-Long: " + std::string(100'000, 'a') + "\r\n"), 431);
}

TEST_F(Hostile, BytesThatAreReadDifferently) {
    const std::string length = "Content-Length: " + std::to_string(smuggled.size());
    for (const std::string& header :
         std::vector<std::string>{"X: a\n" + length + "\r\n", "X: a\r" + length + "\r\n",
                                  "X: a\n\n", std::string("X\r\n"), "X: a\r\n\t" + length + "\r\n",
                                  std::string("X: a\0b\r\n", 8), length + "\n"})
        expect_refused(post(header, smuggled), 400);
    expect_refused("GET /healthz HTTP/1.1\nHost: x\r\n\r\n", 400);
    expect_refused("\x16\x03\x01\x02\n\r\n", 400);
}

TEST_F(Hostile, RefusalsOfHeadHaveNoBody) {
    Connection connection(server->port());
    connection.send("HEAD /healthz HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nhello");
    EXPECT_EQ(connection.read(true).status, 400);
    EXPECT_TRUE(connection.is_closed());
    Connection broken(server->port());
    broken.send("HEAD /healthz HTTP/1.1\r\nHost: x\r\nX\r\n\r\n");
    EXPECT_EQ(broken.read(true).status, 400);
    EXPECT_TRUE(broken.is_closed());
}

TEST_F(Hostile, RequestLines) {
    expect_refused("nonsense\r\n\r\n", 400);
    expect_refused("GET /%zz HTTP/1.1\r\nHost: x\r\n\r\n", 400);
    expect_refused("GET /a%0d%0ab HTTP/1.1\r\nHost: x\r\n\r\n", 400);
    expect_refused("BREW / HTTP/1.1\r\nHost: x\r\n\r\n", 400);
}

TEST_F(Hostile, RequestsOneAfterTheOther) {
    Connection connection(server->port());
    std::string all;
    for (int i = 0; i < 20; ++i)
        all += post("Content-Length: 2\r\n", "{}") + get("") + "\r\n";
    connection.send(all);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(connection.read().status, 422) << i;
        EXPECT_EQ(connection.read().status, 200) << i;
    }
    connection.send(get("Connection: x, Close\r\n"));
    const Answer last = connection.read();
    EXPECT_EQ(last.header("connection"), "close");
    EXPECT_TRUE(connection.is_closed());
    Connection old(server->port());
    old.send("GET /healthz HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    EXPECT_EQ(old.read().status, 200);
    EXPECT_TRUE(old.is_closed());
}

TEST_F(Hostile, IdleConnectionsDoNotStopTheService) {
    std::vector<std::unique_ptr<Connection>> idle;
    for (int i = 0; i < 200; ++i) {
        idle.push_back(std::make_unique<Connection>(server->port()));
        idle.back()->send("GET /healthz HTTP/1.1\r\nHost:");
    }
    EXPECT_EQ(ask(server->port(), "GET", "/healthz").status, 200);
}

}  // namespace
}  // namespace tinsmith::e2e
