// SPDX-License-Identifier: Apache-2.0
// JSON that is deep, wide or long, sent to every route that reads it.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/attack/lying_files.hpp"
#include "tests/attack/victim.hpp"
#include "tests/durability/random_shapes.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kJson = "Content-Type: application/json";
const std::string kSession = "/v1/sessions/honest";

double mebi(const std::string& body) {
    return static_cast<double>(body.size()) / (1 << 20);
}

/// What a body may cost while it is read, itself included, beside the limit.
double room_for(const std::string& body) {
    return kMostMebiForRefused + 3 * mebi(body);
}

class BodyAttack : public testing::Test {
  protected:
    void SetUp() override { ASSERT_NE(victim_.port(), 0); }
    void TearDown() override { EXPECT_EQ(victim_.server().stop(), ""); }

    Answer post(const std::string& target, const std::string& body, int longest = 10) {
        victim_.watch_memory();
        Connection connection(victim_.port(), longest);
        connection.send(request_text("POST", target, {kJson}, body));
        return connection.read();
    }

    void expect_refused(const std::string& target, const std::string& body, int status) {
        SCOPED_TRACE(target + " " + body.substr(0, 60));
        const Answer answer = post(target, body);
        EXPECT_EQ(answer.status, status) << answer.body.substr(0, 500);
        EXPECT_EQ(answer.header("content-type"), "application/problem+json");
        EXPECT_EQ(victim_.harm(room_for(body)), "");
    }

    Victim victim_;
};

const std::vector<std::string> kReadersOfJson{"/v1/sessions",        kSession + "/polygons",
                                              kSession + "/edits",   kSession + "/elevation",
                                              kSession + "/profile", kSession + "/volume"};

TEST_F(BodyAttack, Deep) {
    for (const std::string& target : kReadersOfJson) {
        expect_refused(target, std::string(1'000'000, '['), 400);
        expect_refused(target, repeated("{\"a\":", 200'000), 400);
        expect_refused(target, "{\"a\":" + std::string(1000, '[') + std::string(1000, ']') + "}",
                       400);
    }
}

TEST_F(BodyAttack, Wide) {
    const std::size_t count = is_long_form() ? 10'000'000 : 200'000;
    for (const std::string& target : kReadersOfJson) {
        expect_refused(target, "[0" + repeated(",0", count) + "]", 422);
        expect_refused(target, "{\"a\":0" + repeated(",\"b\":0", count) + "}", 422);
    }
    expect_refused(kSession + "/polygons",
                   R"({"type":"Polygon","coordinates":[[])" + repeated(",[]", count) + "]}",
                   is_long_form() ? 413 : 422);  // rings count as positions
}

TEST_F(BodyAttack, LongTextsAndNumbers) {
    const std::size_t count = is_long_form() ? 100'000'000 : 4'000'000;
    for (const std::string& target : kReadersOfJson) {
        expect_refused(target, "{\"" + std::string(count, 'a') + "\":0}", 422);
        expect_refused(target, std::string(count, '9'), 422);
        expect_refused(target, "{\"a\":[\"" + std::string(count, 'a'), 422);
    }
}

/// A circle about the middle of the honest session of 20 by 20.
std::string circle(std::size_t count) {
    std::string text;
    text.reserve(count * 24);
    std::string first;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        std::array<char, 64> at{};
        std::snprintf(at.data(), at.size(), "[%.8f,%.8f]", 9.5 + 8 * std::cos(angle),
                      9.5 + 8 * std::sin(angle));
        if (i == 0) first = at.data();
        text += at.data();
        text += ',';
    }
    return polygon_text("[" + text + first + "]");
}

/// So many numbers of 8 digits after the point, by threes and the like in brackets.
std::string tuples(std::size_t count, int size, const std::string& close = "") {
    std::string text;
    text.reserve(count * 24);
    for (std::size_t i = 0; i < count; ++i) {
        text += i == 0 ? "[" : ",[";
        for (int k = 0; k < size; ++k) {
            std::array<char, 32> number{};
            std::snprintf(number.data(), number.size(), k == 0 ? "%.8f" : ",%.8f",
                          100 * std::sin(static_cast<double>(i) + k));
            text += number.data();
        }
        text += "]";
    }
    return text + close;
}

std::string in_turn(std::size_t count, const std::string& one) {
    std::string text = one;
    text.reserve(count * (one.size() + 1));
    for (std::size_t i = 1; i < count; ++i)
        text += "," + one;
    return text;
}

/// All of it is read, and all is as it should be but for the last value.
TEST_F(BodyAttack, ReadingTakesThriceTheBody) {
    const std::size_t count = is_long_form() ? 4'000'000 : 200'000;
    Victim wide({"--max-polygon-vertices", "20000000"});
    const std::string polygons = kSession + "/polygons";
    const std::string geometry = R"({"type":"Polygon","coordinates":[)";
    struct Large {
        const char* what;
        std::string target;
        std::string body;
    };
    const std::vector<Large> all{
        {"a polygon", polygons, geometry + "[" + tuples(count, 2, ",[0]]]}")},
        {"with elevations", polygons, geometry + "[" + tuples(count, 3, ",[0]]]}")},
        {"a MultiPolygon", polygons,
         R"({"type":"MultiPolygon","coordinates":[)" +
             in_turn(count / 50, "[[" + tuples(50, 2) + "]]") + ",[[[0]]]]}"},
        {"a collection", polygons,
         R"({"type":"FeatureCollection","features":[)" +
             in_turn(count / 50, R"({"type":"Feature","id":1,"properties":{"name":"lake","area":)"
                                 R"(12.5,"owner":"none","use":"water"},"geometry":)" +
                                     geometry + "[" + tuples(20, 2) + "]]}}") +
             ",0]}"},
        {"a mesh", "/v1/sessions",
         R"({"mesh":{"vertices":[)" + tuples(count, 3) + R"(],"triangles":[)" +
             in_turn(count, "[123456,123457,123458]") + ",[0]]}}"},
        {"points", "/v1/sessions", R"({"points":[)" + tuples(count, 3, ",[0]]}")},
        {"questions", kSession + "/elevation",
         R"({"points":[)" + tuples(std::min<std::size_t>(count, 99'999), 2, ",[0]]}")},
    };
    for (const auto& [what, target, body] : all) {
        SCOPED_TRACE(what);
        wide.watch_memory();
        Connection connection(wide.port(), 120);
        connection.send(request_text("POST", target, {kJson}, body));
        const Answer answer = connection.read();
        EXPECT_EQ(answer.status, 422) << answer.body.substr(0, 300);
        std::cout << what << ": " << mebi(body) << " MiB, " << wide.growth() << " MiB held, "
                  << wide.growth() / mebi(body) << " times\n";
        EXPECT_EQ(wide.harm(room_for(body)), "");
    }
    EXPECT_EQ(wide.server().stop(), "");
}

/// Done or refused, but in time, in memory that goes with the body, and nothing else stands still.
TEST_F(BodyAttack, APolygonOfManyVertices) {
    const std::size_t count = is_long_form() ? 10'000'000 : 200'000;
    const std::string body = circle(count);
    const auto start = Clock::now();
    const Answer answer = post(kSession + "/polygons", body, 300);
    std::cout << count << " vertices, " << mebi(body) << " MiB: " << answer.status << " after "
              << std::chrono::duration<double>(Clock::now() - start).count() << " s, "
              << victim_.growth() << " MiB; " << answer.body.substr(0, 300) << "\n";
    EXPECT_TRUE(answer.status == 200 || answer.status == 413 || answer.status == 422 ||
                answer.status == 503)
        << answer.status;
    EXPECT_EQ(victim_.harm(5000), "");
}

/// Where the operator has allowed as many, it is done, or another limit is named.
TEST_F(BodyAttack, APolygonOfManyVerticesThatMayBeAsLong) {
    const std::size_t count = is_long_form() ? 10'000'000 : 300'000;
    Victim wide({"--max-polygon-vertices", "20000000", "--max-session-bytes", "1GB",
                 "--max-edit-seconds", "120"});
    const std::string body = circle(count);
    wide.watch_memory();
    const auto start = Clock::now();
    Connection connection(wide.port(), 300);
    connection.send(request_text("POST", kSession + "/polygons", {kJson}, body));
    const Answer answer = connection.read();
    std::cout << count << " vertices, " << mebi(body) << " MiB: " << answer.status << " after "
              << std::chrono::duration<double>(Clock::now() - start).count() << " s, "
              << wide.growth() << " MiB; " << answer.body.substr(0, 300) << "\n";
    if (is_long_form()) {
        EXPECT_EQ(answer.status, 422) << answer.body;
        EXPECT_NE(answer.body.find("max_session_bytes"), std::string::npos) << answer.body;
    } else {
        EXPECT_EQ(answer.status, 200) << answer.body;
    }
    EXPECT_EQ(wide.harm(6000), "");
    EXPECT_EQ(wide.server().stop(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
