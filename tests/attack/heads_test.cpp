// SPDX-License-Identifier: Apache-2.0
// Requests that are refused by their heads, at their full size: what 4.3 of the table in README.md
// did to the HTTP library alone. tests/e2e/hostile_test.cpp has the same shapes, small.
#include <memory>

#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/attack/victim.hpp"

namespace tinsmith::e2e {
namespace {

constexpr std::size_t kMebi = std::size_t{1} << 20;

class HeadAttack : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        victim = new Victim({"--max-body-bytes", "1048576"});
        ASSERT_NE(victim->port(), 0);
    }
    static void TearDownTestSuite() {
        EXPECT_EQ(victim->harm_at_the_end(), "");
        delete victim;
        victim = nullptr;
    }
    void SetUp() override { victim->watch_memory(); }

    /// One answer, a problem of that status, the end of the connection, and no harm done.
    static void expect_refused(Connection& connection, int status) {
        const Answer answer = connection.read();
        EXPECT_EQ(answer.status, status) << answer.body;
        EXPECT_EQ(answer.header("content-type"), "application/problem+json");
        EXPECT_TRUE(connection.is_closed());
        EXPECT_EQ(victim->harm(), "");
    }

    static void expect_refused(const std::string& bytes, int status) {
        Connection connection(victim->port());
        connection.send(bytes);
        expect_refused(connection, status);
    }

    static std::string post(const std::string& headers) {
        return "POST /v1/sessions HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n" +
               headers + "\r\n";
    }
    static std::string get(const std::string& headers) {
        return "GET /v1/limits HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n";
    }

    static inline Victim* victim = nullptr;
};

/// So many zeros, as gzip has them: a thousandth of it.
std::string gzip_of_zeros(std::size_t count) {
    z_stream stream{};
    constexpr int kGzip = 15 + 16;
    deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY);
    std::string zeros(kMebi, '\0');
    std::string packed(2 * kMebi, '\0');
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    for (std::size_t done = 0; done < count; done += zeros.size()) {
        stream.next_in = reinterpret_cast<Bytef*>(zeros.data());
        stream.avail_in = static_cast<uInt>(zeros.size());
        deflate(&stream, done + zeros.size() < count ? Z_NO_FLUSH : Z_FINISH);
    }
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

TEST_F(HeadAttack, AChunkedBodyOf64Mebibytes) {
    Connection connection(victim->port());
    connection.send(post("Transfer-Encoding: chunked\r\n"));
    const std::string chunk = "100000\r\n" + std::string(kMebi, 'x') + "\r\n";
    for (int i = 0; i < 64; ++i)
        connection.send(chunk);
    connection.send("0\r\n\r\n");
    expect_refused(connection, 411);
}

TEST_F(HeadAttack, AGzipBomb) {
    const std::string bomb = gzip_of_zeros((is_long_form() ? 200 : 64) * kMebi);
    ASSERT_LT(bomb.size(), kMebi);
    for (const char* coding : {"gzip", "x-gzip", "identity, gzip", "br", "deflate"}) {
        expect_refused(post("Content-Encoding: " + std::string(coding) +
                            "\r\nContent-Length: " + std::to_string(bomb.size()) + "\r\n") +
                           bomb,
                       415);
    }
}

TEST_F(HeadAttack, FiftyThousandHeaders) {
    std::string headers;
    for (int i = 0; i < 50'000; ++i)
        headers += "X-" + std::to_string(i) + ": " + std::string(1000, 'y') + "\r\n";
    expect_refused(get(headers), 431);
}

TEST_F(HeadAttack, AHeaderOf32Mebibytes) {
    expect_refused(get("X-Long: " + std::string(32 * kMebi, 'a') + "\r\n"), 431);
}

TEST_F(HeadAttack, ATargetOf32Mebibytes) {
    expect_refused("GET /" + std::string(32 * kMebi, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n", 414);
}

TEST_F(HeadAttack, ALineWithNoEnd) {
    Connection connection(victim->port());
    const std::string part(kMebi, 'a');
    for (int i = 0; i < 32; ++i)
        connection.send(part);
    expect_refused(connection, 414);
}

TEST_F(HeadAttack, TwoHundredOverlappingRanges) {
    std::string ranges = "Range: bytes=0-";
    for (int i = 0; i < 200; ++i)
        ranges += ",0-";
    expect_refused(get(ranges + "\r\n"), 416);
}

TEST_F(HeadAttack, ABodyOfGetInASecondPacket) {
    Connection connection(victim->port());
    const std::string smuggled = "GET /v1/sessions HTTP/1.1\r\nHost: x\r\n\r\n";
    connection.send(get("Content-Length: " + std::to_string(smuggled.size()) + "\r\n"));
    const Answer answer = connection.read();
    EXPECT_EQ(answer.status, 400) << answer.body;
    connection.send(smuggled);
    EXPECT_EQ(connection.read().status, 0) << "the body was taken for a request";
    EXPECT_EQ(victim->harm(), "");
}

TEST_F(HeadAttack, ALengthBesideChunks) {
    expect_refused(post("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n") + "0\r\n\r\n", 411);
}

TEST_F(HeadAttack, ALengthThatIsNone) {
    expect_refused(post("Content-Length: abc\r\n"), 400);
}

TEST_F(HeadAttack, ALengthOfAnExbibyte) {
    expect_refused(post("Content-Length: 1152921504606846976\r\n"), 413);
    expect_refused(post("Content-Length: 18446744073709551615\r\n"), 413);
}

TEST_F(HeadAttack, AForgedAddress) {
    expect_refused(get("REMOTE_ADDR: 10.0.0.1\r\n"), 400);
    expect_refused(get("remote_addr: 10.0.0.1\r\nLOCAL_PORT: 1\r\n"), 400);
}

/// The refusals themselves cost next to nothing, however many come.
TEST_F(HeadAttack, ThousandsOfRefusals) {
    const int count = is_long_form() ? 20'000 : 200;
    const std::string refused = post("Content-Length: 99999999\r\n");
    for (int i = 0; i < count; ++i) {
        Connection connection(victim->port());
        connection.send(refused);
        ASSERT_EQ(connection.read().status, 413);
    }
    EXPECT_EQ(victim->harm(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
