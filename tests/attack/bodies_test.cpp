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

/// What a body may cost while it is read, beside the limit. The JSON library keeps the text of the
/// value it is at, twice, in buffers that double.
double room_for(const std::string& body, double times = 3) {
    return kMostMebiForRefused + times * mebi(body);
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

    void expect_refused(const std::string& target, const std::string& body, int status,
                        double times = 3) {
        SCOPED_TRACE(target + " " + body.substr(0, 60));
        const Answer answer = post(target, body);
        EXPECT_EQ(answer.status, status) << answer.body.substr(0, 500);
        EXPECT_EQ(answer.header("content-type"), "application/problem+json");
        EXPECT_EQ(victim_.harm(room_for(body, times)), "");
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
                   R"({"type":"Polygon","coordinates":[[])" + repeated(",[]", count) + "]}", 422);
}

TEST_F(BodyAttack, LongTextsAndNumbers) {
    const std::size_t count = is_long_form() ? 100'000'000 : 4'000'000;
    for (const std::string& target : kReadersOfJson) {
        expect_refused(target, "{\"" + std::string(count, 'a') + "\":0}", 422, 9);
        expect_refused(target, std::string(count, '9'), 422, 9);
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

}  // namespace
}  // namespace tinsmith::e2e
