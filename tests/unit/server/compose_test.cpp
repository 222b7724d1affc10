// SPDX-License-Identifier: Apache-2.0
// docker/compose.yaml: by what docker/README.md says of its limits the server stays within its
// container's memory, and the edge before it allows what it takes.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/config.hpp"

namespace tinsmith::server {
namespace {

constexpr double kMebi = 1 << 20;
constexpr double kGibi = 1 << 30;
/// Of the container's memory, for what the sum leaves out: journal, pages of files, the allocator.
constexpr double kMostOfTheMemory = 0.9;

std::string text_of(const char* path) {
    std::ifstream file(TINSMITH_SOURCE_DIR + std::string(path));
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The first group of each match.
std::vector<std::string> all_of(const std::string& text, const char* pattern) {
    const std::regex expression(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
        found.push_back((*at)[1].str());
    return found;
}

/// What compose.yaml says of the server, which is its first service.
std::string service() {
    const std::string text = text_of("/docker/compose.yaml");
    return text.substr(0, text.find("\n  edge:"));
}

/// As the server reads it in that container; nothing where it would not start.
std::optional<ServeConfig> configuration() {
    std::map<std::string, std::string> environment;
    const std::string text = service();
    const std::regex line(R"re(\n      (TINSMITH_[A-Z_]+): "?([^"\n]+)"?)re");
    for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at)
        environment[(*at)[1].str()] = (*at)[2].str();
    const auto commands = all_of(text, R"(\n    command: \[(.*)\])");
    if (environment.empty() || commands.size() != 1) return std::nullopt;
    std::vector<std::string> words = all_of(commands[0], R"re(([^ ",]+))re");
    words.insert(words.begin(), "tinsmith");
    std::vector<const char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(word.c_str());
    for (const auto& [name, value] : environment)
        ::setenv(name.c_str(), value.c_str(), 1);
    const Command command =
        parse_command_line(static_cast<int>(arguments.size()), arguments.data());
    for (const auto& [name, value] : environment)
        ::unsetenv(name.c_str());
    const auto* config = std::get_if<ServeConfig>(&command);
    return config == nullptr ? std::nullopt : std::optional(*config);
}

/// The sum of docker/README.md, "Limits".
double most_memory(const Limits& limits, std::size_t threads) {
    const auto number = [](auto value) { return static_cast<double>(value); };
    const double a_request =
        std::max(4 * number(limits.max_body_bytes), 128 * number(limits.max_vertices));
    const double an_answer = 0.9 * number(limits.max_session_bytes);
    return number(limits.max_memory_bytes) +
           number(limits.mesh_cache + limits.kept_answers + limits.job_bytes) +
           number(std::min(limits.max_requests, threads) + limits.job_threads) * a_request +
           number(threads) * an_answer + 16 * kMebi;
}

TEST(Compose, NeedsNoMoreMemoryThanTheContainerHas) {
    const auto config = configuration();
    ASSERT_TRUE(config);
    const auto given = all_of(service(), R"(\n    mem_limit: (\d+)g\n)");
    ASSERT_EQ(given.size(), 1U);
    const double most = most_memory(config->http.limits, config->http.threads) / kGibi;
    EXPECT_LT(most, kMostOfTheMemory * std::stod(given[0]));
    // Whoever runs it reads the sum, too.
    char told[32];
    std::snprintf(told, sizeof told, "%.1f GiB", most);
    EXPECT_NE(service().find(told), std::string::npos) << told;
    EXPECT_NE(text_of("/docker/README.md").find(std::string("the sum, ") + told), std::string::npos)
        << told;
    // A terrain of the largest kind has room: a session takes 125 bytes a vertex.
    EXPECT_GT(config->http.limits.max_session_bytes, 125 * config->http.limits.max_vertices);
}

TEST(Compose, AgreesWithTheEdge) {
    const auto config = configuration();
    ASSERT_TRUE(config);
    const std::string edge = text_of("/docker/haproxy.cfg");
    const std::string body = std::to_string(config->http.limits.max_body_bytes);
    EXPECT_EQ(all_of(edge, R"(req\.body_size gt (\d{7,}))"), std::vector<std::string>{body});
    EXPECT_EQ(all_of(edge, R"(max_body_bytes is (\d+))"), std::vector<std::string>{body});
    std::size_t at_a_time = 0;
    for (const std::string& one : all_of(edge, R"(\n    server .* maxconn (\d+) )"))
        at_a_time += std::stoul(one);
    EXPECT_GT(at_a_time, 0U);
    EXPECT_LT(at_a_time, config->http.threads);
    EXPECT_LT(at_a_time, config->http.limits.max_requests);
    EXPECT_NE(edge.find("are " + std::to_string(at_a_time) + "\n"), std::string::npos);
}

}  // namespace
}  // namespace tinsmith::server
