// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_head.hpp"

#include <string>

#include <gtest/gtest.h>

#include "server/http/plain_answer.hpp"
#include "server/limits.hpp"

namespace tinsmith::server {
namespace {

const std::string kGet = "GET / HTTP/1.1\r\nHost: x\r\n";

/// The status the head is refused with, 0 where it passes.
int verdict(const std::string& head) {
    const auto problem = check_head_bytes(head);
    return problem ? api::problem_status(problem->type) : 0;
}

TEST(RequestHead, EndsAtItsEmptyLine) {
    EXPECT_EQ(size_of_head(""), 0U);
    EXPECT_EQ(size_of_head(kGet), 0U);
    EXPECT_EQ(size_of_head(kGet + "\r"), 0U);
    EXPECT_EQ(size_of_head(kGet + "\r\n"), kGet.size() + 2);
    EXPECT_EQ(size_of_head(kGet + "\r\nGET /"), kGet.size() + 2);
    EXPECT_EQ(size_of_head("GET / HTTP/1.1\n\r\nrest"), 17U) << "the library ends it there, too";
    EXPECT_EQ(size_of_head("GET / HTTP/1.1\n\nrest"), 0U);
}

TEST(RequestHead, EndsInThePlaceWhereverItWasLookedAt) {
    const std::string head = kGet + "\r\n";
    for (std::size_t looked_at = 0; looked_at < head.size(); ++looked_at) {
        EXPECT_EQ(size_of_head(std::string_view(head).substr(0, looked_at)), 0U);
        EXPECT_EQ(size_of_head(head + "body", looked_at), head.size()) << looked_at;
    }
}

TEST(RequestHead, PassesPlainHeads) {
    EXPECT_EQ(verdict(kGet + "\r\n"), 0);
    EXPECT_EQ(verdict(kGet + "X-Empty:\r\nX-Tab:\ta\tb\r\nX-Bytes: \xC3\xA9\r\n\r\n"), 0);
}

TEST(RequestHead, RefusesWhatOthersReadDifferently) {
    for (const std::string& line :
         {std::string("X: a\nContent-Length: 5\r\n"), std::string("X: a\n"),
          std::string("X: a\rContent-Length: 5\r\n"), std::string("X: a\r\r\n"),
          std::string("X: a\r\n b\r\n"), std::string("X: a\r\n\tb\r\n"), std::string("nothing\r\n"),
          std::string("X: a\0b\r\n", 8), std::string("X: a\x7F\r\n"), std::string("X\x01: a\r\n"),
          std::string(" X: a\r\n"), std::string("\n")})
        EXPECT_EQ(verdict(kGet + line + "\r\n"), 400) << testing::PrintToString(line);
    EXPECT_EQ(verdict("GET / HTTP/1.1\nHost: x\r\n\r\n"), 400);
    for (const std::string header : {"Content-Length:", "Content-Length: ", "Content-Length: %32",
                                     "Transfer-Encoding:", "TRANSFER-ENCODING:\t",
                                     "Content-Length : 5", "Content Length: 5", ":", ": 5"})
        EXPECT_EQ(verdict(kGet + header + "\r\n\r\n"), 400) << header;
    for (const std::string line :
         {" GET / HTTP/1.1", "GET  / HTTP/1.1", "GET / HTTP/1.1 ", "GET / x HTTP/1.1", "GET /",
          "GET HTTP/1.1", "GET / HTTP/2.0", "GET / http/1.1", "G(T / HTTP/1.1", "GET\t/\tHTTP/1.1"})
        EXPECT_EQ(verdict(line + "\r\nHost: x\r\n\r\n"), 400) << line;
    EXPECT_EQ(verdict("GET /\x01 HTTP/1.1\r\nHost: x\r\n\r\n"), 400);
}

TEST(RequestHead, CountsHeaders) {
    const auto head = [](std::size_t headers) {
        std::string text = "GET / HTTP/1.1\r\n";
        for (std::size_t i = 0; i < headers; ++i)
            text += "X: y\r\n";
        return text + "\r\n";
    };
    EXPECT_EQ(verdict(head(kMaxHeaders)), 0);
    EXPECT_EQ(verdict(head(kMaxHeaders + 1)), 431);
}

TEST(RequestHead, BoundsALine) {
    const auto told = [](const std::string& head) {
        const auto problem = check_head_bytes(head);
        return problem ? std::to_string(api::problem_status(problem->type)) + " " + problem->detail
                       : std::string();
    };
    const auto header = [](std::size_t size) {
        return kGet + "X-Long: " + std::string(size - 8, 'a') + "\r\n\r\n";
    };
    EXPECT_EQ(told(header(kMaxLineBytes)), "");
    EXPECT_EQ(told(header(kMaxLineBytes + 1)),
              "431 The header X-Long is longer than 8190 bytes, its name included.");
    const auto line = [](const std::string& begin, std::size_t size) {
        return begin + std::string(size - begin.size() - 9, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n";
    };
    EXPECT_EQ(told(line("GET /?a=", kMaxLineBytes)), "");
    EXPECT_EQ(told(line("GET /?a=", kMaxLineBytes + 1)),
              "414 The request line, which has the query, is longer than 8190 bytes.");
    EXPECT_EQ(told(line("GET /", kMaxLineBytes + 1)), "414 The path is longer than 512 bytes.");
}

TEST(RequestHead, FindsRangesOfOtherUnits) {
    const auto found = [](const std::string& headers) {
        const std::string head = kGet + headers + "\r\n";
        const auto range = range_of_other_unit(head);
        return range ? head.substr(range->begin, range->size) : std::string();
    };
    EXPECT_EQ(found(""), "");
    EXPECT_EQ(found("Range: bytes=0-5\r\n"), "");
    EXPECT_EQ(found("range:bytes=0-1,2-3\r\nX-Range: items=0-5\r\n"), "");
    EXPECT_EQ(found("Range: items=0-5\r\n"), "Range: items=0-5\r\n");
    EXPECT_EQ(found("Range: bytes=0-5\r\nRANGE:x\r\nX: y\r\n"), "RANGE:x\r\n");
    EXPECT_EQ(found("Range:\r\n"), "Range:\r\n");
}

TEST(RequestHead, TellsALongPathFromLongHeaders) {
    const std::string much(kMaxHeadBytes, 'a');
    EXPECT_EQ(head_too_large("GET /" + much).type, api::ProblemType::PathTooLong);
    EXPECT_NE(head_too_large("GET /" + much).detail.find("path"), std::string::npos);
    EXPECT_NE(head_too_large("GET /?" + much).detail.find("query"), std::string::npos);
    EXPECT_EQ(head_too_large(kGet + "X: " + much).type, api::ProblemType::TooManyHeaders);
}

TEST(RequestHead, TellsOfBytesWhatIsPlain) {
    const auto told = [](const std::string& bytes) {
        const Request request = request_of_bytes(bytes);
        return request.method + "|" + request.path;
    };
    EXPECT_EQ(told("GET /v1/limits?a=b HTTP/1.1\r\nX"), "GET|/v1/limits");
    EXPECT_EQ(told("HEAD /"), "HEAD|/");
    EXPECT_EQ(told("GET /a\x1B[31m HTTP/1.1\r\n"), "GET|");
    EXPECT_EQ(told("GET /" + std::string(kMaxPathBytes, 'a')), "GET|");
    EXPECT_EQ(told("nonsense\r\n\r\n"), "-|");
    EXPECT_EQ(told("get / HTTP/1.1"), "-|");
    EXPECT_EQ(told("\x16\x03\x01"), "-|") << "a client that speaks TLS";
    EXPECT_EQ(told(""), "-|");
}

}  // namespace
}  // namespace tinsmith::server
