// SPDX-License-Identifier: Apache-2.0
// Which way a request goes to the server: what may have a long answer never takes the way of short
// ones, however it is spelled, so that those who read slowly hold up nobody else.
#include <chrono>
#include <list>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/attack/bad_server.hpp"
#include "tests/attack/proxy.hpp"
#include "tests/attack/victim.hpp"
#include "tests/durability/bench_print.hpp"
#include "tests/durability/random_shapes.hpp"

namespace tinsmith::e2e {
namespace {

using Clock = std::chrono::steady_clock;

const std::string kJson = "Content-Type: application/json";
const std::string kDemo = "/v1/sessions/demo";
/// Before a request that waits behind others is refused (`timeout queue`).
constexpr double kMostMilliseconds = 4000;

/// The backend that HAProxy's log has for the request with that in its target; empty: none.
std::string way_of(const Proxy& proxy, const std::string& mark) {
    // The line is written once the answer is on its way.
    for (int i = 0; i < 500; ++i) {
        const std::string log = proxy.output();
        const std::size_t at = log.find(mark + " HTTP/1.1");
        const std::size_t line = at == std::string::npos ? at : log.rfind('\n', at) + 1;
        if (at != std::string::npos && log.find('\n', at) != std::string::npos) {
            const std::size_t start = log.find("] edge ", line) + 7;
            return log.substr(start, log.find('/', start) - start);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
}

struct Way {
    const char* method;
    std::string target;
    const char* way;
    std::vector<std::string> headers = {};
};

TEST(EdgeWays, AreShortForWhatIsKnownToBeShortAlone) {
    if (Proxy::program().empty())
        GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
    const BadServer server;
    const Proxy proxy(server.port());
    ASSERT_NE(proxy.port(), 0) << proxy.output();
    const std::string glb = "Accept: model/gltf-binary", json = "Accept: application/json";
    const std::string delta = "Accept: application/vnd.tinsmith.delta";
    const std::vector<Way> ways{
        {"GET", "/readyz", "quick"},
        {"GET", "/v1/limits", "quick"},
        {"HEAD", kDemo, "quick"},
        {"GET", kDemo, "quick"},
        {"GET", kDemo + "/elevation", "quick"},
        {"GET", "/v1/jobs/0123", "quick"},
        {"OPTIONS", kDemo + "/polygons", "quick"},
        {"GET", "/", "meshes"},
        {"GET", "/openapi.json", "meshes"},
        {"GET", "/v1/sessions", "meshes"},
        {"GET", "/v1/jobs", "meshes"},
        {"GET", "/v1/jobs/0123/result", "meshes"},
        {"GET", kDemo + "/mesh", "meshes"},
        {"GET", kDemo + "/mesh.json", "meshes"},
        {"GET", kDemo + "/%6desh.json", "meshes"},
        {"GET", kDemo + "/%6Desh.json", "meshes"},
        {"GET", "/v1/%73essions/demo/mesh%2ejson", "meshes"},
        {"GET", "/%76%31/limits", "meshes"},
        {"GET", kDemo + "/elevation%2f", "meshes"},
        {"GET", kDemo + "/polygons", "meshes"},
        {"GET", kDemo + "/polygons/p1", "meshes"},
        {"GET", kDemo + "/regions", "meshes"},
        {"GET", kDemo + "/constraints", "meshes"},
        {"GET", kDemo + "/locks", "meshes"},
        {"GET", kDemo + "/history/2", "meshes"},
        {"POST", kDemo + "/elevation", "meshes"},
        {"POST", kDemo + "/profile", "meshes"},
        {"POST", "/v1/integrate", "meshes"},
        {"POST", "/v1/sessions", "changes"},
        {"PUT", kDemo, "changes"},
        {"DELETE", kDemo, "changes"},
        {"DELETE", "/v1/jobs/0123", "changes"},
        {"POST", kDemo + "/polygons", "changes"},
        {"POST", kDemo + "/polygons", "changes", {json}},
        {"POST", kDemo + "/polygons", "changes", {"Accept: */*"}},
        {"POST", kDemo + "/polygons", "changes", {delta}},
        {"DELETE", kDemo + "/polygons/p1", "changes"},
        {"POST", kDemo + "/undo", "changes"},
        {"PUT", kDemo + "/locks", "changes"},
        {"POST", kDemo + "/polygons", "meshes", {glb}},
        {"POST", kDemo + "/polygons", "meshes", {"Accept: application/json;q=0.1, model/*"}},
        {"POST", kDemo + "/polygons", "meshes", {json, glb}},
        {"POST", kDemo + "/edits", "meshes", {"ACCEPT: MODEL/GLTF-BINARY"}},
        {"POST", kDemo + "/%70olygons", "meshes"},
    };
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const Way& each = ways[i];
        const std::string target = each.target + "?n=" + std::to_string(i);
        SCOPED_TRACE(each.method + (" " + target));
        EXPECT_EQ(ask(proxy.port(), each.method, target, each.headers).status, 200);
        EXPECT_EQ(way_of(proxy, target), each.way);
    }
}

/// A client that asks and does not read.
void ask_and_wait(std::list<Connection>& readers, int port, const std::string& target) {
    readers.emplace_back(port).send(request_text("GET", target));
}

TEST(EdgeWays, OfSlowReadersAreNotThoseOfOthers) {
    if (Proxy::program().empty())
        GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
    Victim victim;
    ASSERT_NE(victim.port(), 0);
    const Proxy proxy(victim.port());
    ASSERT_NE(proxy.port(), 0) << proxy.output();
    // Longer than what sockets hold by themselves, 4 MiB on each side of the proxy.
    Dice dice(7);
    const int direct = victim.port();
    ASSERT_EQ(ask(direct, "PUT", kDemo, {kJson}, grid_text(dice, 500)).status, 201);
    ASSERT_GT(ask(direct, "GET", kDemo + "/mesh.json").body.size(), std::size_t{12} << 20);
    victim.watch_memory();
    {
        std::list<Connection> readers;
        // Some hold the server for certain, for their answers have begun; then a crowd.
        for (int i = 0; i < 5; ++i)
            ask_and_wait(readers, proxy.port(), kDemo + "/%6desh.json");
        for (Connection& reader : readers)
            EXPECT_FALSE(reader.is_closed());
        for (int i = 0; i < 20; ++i) {
            for (const char* mesh : {"/%6desh.json", "/mesh.js%6Fn", "/mesh.json"})
                ask_and_wait(readers, proxy.port(), kDemo + mesh);
        }
        for (int i = 0; i < 20; ++i) {
            const auto start = Clock::now();
            const Answer answer = ask(proxy.port(), "GET", "/v1/sessions/honest/elevation?x=4&y=4");
            ASSERT_EQ(answer.status, 200) << answer.body;
            EXPECT_LT(milliseconds_since(start), kMostMilliseconds);
            const Answer change = ask(proxy.port(), "POST", kDemo + "/undo");
            ASSERT_EQ(change.status, 409) << change.body;  // there is nothing to undo
            EXPECT_LT(milliseconds_since(start), 2 * kMostMilliseconds);
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }
    EXPECT_EQ(victim.harm_at_the_end(), "");
}

}  // namespace
}  // namespace tinsmith::e2e
