// SPDX-License-Identifier: Apache-2.0
// What the process holds at most is what docker/README.md says of its limits, whatever is sent at a
// time: small bodies that are large meshes, and every representation of those.
#include <algorithm>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/attack/victim.hpp"

namespace tinsmith::e2e {
namespace {

constexpr int kThreads = 6;
constexpr double kMebi = 1 << 20;
/// Of the process itself, and what the allocator cannot join.
constexpr double kSlack = 16;
/// What docker/README.md says of a terrain that is read.
constexpr double kBytesOfVertex = 128;

struct Body {
    std::string name;
    std::string type;
    std::string text;
};

/// Two bytes a vertex.
Body grid(int side, bool is_flat = false) {
    std::string text = R"({"grid": {"origin": [0,0], "cell": [1,1], "columns": )" +
                       std::to_string(side) + R"(, "rows": )" + std::to_string(side) +
                       R"(, "elevations": [)";
    for (int i = 0; i < side * side; ++i) {
        if (i > 0) text += ',';
        text += is_flat ? '0' : static_cast<char>('0' + (i * 7 + i / side) % 10);
    }
    return {"a grid", "application/json", text + "]}}"};
}

Body points(int side) {
    std::string text = R"({"points": [)";
    for (int i = 0; i < side * side; ++i)
        text += (i == 0 ? "[" : ",[") + std::to_string(i % side) + "," + std::to_string(i / side) +
                "," + std::to_string(i * 7 % 10) + "]";
    return {"points", "application/json", text + "]}"};
}

/// As this server compresses it: less than a byte a vertex.
Body draco(int side) {
    Victim server;
    const Body body = grid(side, true);
    const std::string path = "/v1/sessions/flat";
    ask(server.port(), "PUT", path, {"Content-Type: " + body.type}, body.text);
    return {"Draco", "model/gltf-binary",
            ask(server.port(), "GET", path + "/mesh.glb?compression=draco").body};
}

/// Sends the body again and again, and asks for all that can be made of it.
void send_all(int port, const Body& body, int rounds) {
    for (int i = 0; i < rounds; ++i) {
        const Answer made =
            ask(port, "POST", "/v1/sessions", {"Content-Type: " + body.type}, body.text);
        // There is no room for all of them.
        EXPECT_TRUE(made.status == 201 || made.status == 507) << made.status << made.body;
        if (made.status != 201) continue;
        const std::string session = made.header("location");
        for (const char* mesh : {"/mesh.glb", "/mesh.json", "/mesh.gltf", "/mesh.obj", "/mesh.xml",
                                 "/mesh.glb?compression=meshopt"}) {
            const int status = ask(port, "GET", session + mesh).status;
            EXPECT_TRUE(status == 200 || status == 507) << mesh << status;
        }
        ask(port, "DELETE", session);
    }
}

TEST(MemoryAttack, HoldsNoMoreThanItsLimitsSay) {
    const int side = is_long_form() ? 1000 : 300;
    const int most_vertices = side * side;
    constexpr double kBody = 2;
    const double memory = is_long_form() ? 320 : 32;
    const auto mebi = [](double value) { return std::to_string(static_cast<int>(value)) + "MB"; };
    // Of points, each with a dozen bytes, as many as a body holds.
    for (const Body& body : {grid(side), points(is_long_form() ? 390 : 300), draco(side)}) {
        ASSERT_LT(static_cast<double>(body.text.size()), kBody * kMebi) << body.name;
        Victim victim({"--threads", std::to_string(kThreads), "--max-body-bytes", mebi(kBody),
                       "--max-memory-bytes", mebi(memory), "--max-session-bytes", mebi(memory),
                       "--mesh-cache", "4MB", "--kept-answers", "1MB", "--job-bytes", "4MB",
                       "--max-vertices", std::to_string(most_vertices), "--max-triangles",
                       std::to_string(2 * most_vertices)});
        ASSERT_NE(victim.port(), 0);
        std::vector<std::thread> threads;
        for (int t = 0; t < kThreads; ++t)
            threads.emplace_back([&] { send_all(victim.port(), body, 3); });
        for (std::thread& thread : threads)
            thread.join();
        const double a_request = std::max(4 * kBody, kBytesOfVertex * most_vertices / kMebi);
        const double told = memory + 4 + 1 + 4 + kThreads * a_request;
        const double held = victim.growth();
        std::cout << body.name << " of " << static_cast<double>(body.text.size()) / kMebi
                  << " MiB: " << held << " MiB held, " << told << " MiB told\n";
        EXPECT_LT(held, told + kSlack) << body.name;
        EXPECT_EQ(victim.harm_at_the_end(told + kSlack), "");
    }
}

/// A mesh that there is no memory for is not built.
TEST(MemoryAttack, BuildsNoMeshBeyondItsMemory) {
    const Body body = grid(900);
    Victim victim({"--max-memory-bytes", "64MB"});
    ASSERT_NE(victim.port(), 0);
    for (const char* target : {"/v1/sessions", "/v1/sessions?repair=true"}) {
        const Answer answer =
            ask(victim.port(), "POST", target, {"Content-Type: " + body.type}, body.text);
        EXPECT_EQ(answer.status, 507);
        EXPECT_NE(answer.body.find("max_memory_bytes"), std::string::npos) << answer.body;
    }
    // 810,000 posts, and the mesh without what makes it a terrain that can be edited.
    EXPECT_EQ(victim.harm_at_the_end(kBytesOfVertex * 810'000 / kMebi + kSlack), "");
}

}  // namespace
}  // namespace tinsmith::e2e
