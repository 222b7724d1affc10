// SPDX-License-Identifier: Apache-2.0
#include "server/config.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "api/openapi.hpp"
#include "server/router.hpp"
#include "server/routes/route_table.hpp"
#include "server/services.hpp"

namespace tinsmith::server {
namespace {

Command parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "tinsmith");
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    Command command = parse_command_line(static_cast<int>(arguments.size()), arguments.data());
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    return command;
}

int exit_code(std::vector<const char*> arguments) {
    const Command command = parse(std::move(arguments));
    return std::holds_alternative<int>(command) ? std::get<int>(command) : -1;
}

ServeConfig serve(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "serve");
    const Command command = parse(std::move(arguments));
    const auto* config = std::get_if<ServeConfig>(&command);
    EXPECT_NE(config, nullptr);
    return config != nullptr ? *config : ServeConfig{};
}

/// A file with that content, gone at the end of the test.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& content)
        : path_(testing::TempDir() + "tinsmith_config_test." + std::to_string(::getpid()) +
                ".toml") {
        std::ofstream(path_) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const char* path() const { return path_.c_str(); }

  private:
    const std::string path_;
};

TEST(CommandLine, AnswersHelpAndVersionByItself) {
    EXPECT_EQ(exit_code({"--help"}), kExitOk);
    EXPECT_EQ(exit_code({"--version"}), kExitOk);
    EXPECT_EQ(exit_code({"serve", "--help"}), kExitOk);
}

TEST(CommandLine, RefusesWrongUsage) {
    EXPECT_EQ(exit_code({}), kExitUsage);
    EXPECT_EQ(exit_code({"dance"}), kExitUsage);
    EXPECT_EQ(exit_code({"serve", "--prot", "1"}), kExitUsage);
    EXPECT_EQ(exit_code({"serve", "--port", "65536"}), kExitUsage);
    EXPECT_EQ(exit_code({"serve", "--threads", "0"}), kExitUsage);
    EXPECT_EQ(exit_code({"integrate", "a.tif"}), kExitUsage);
    for (const char* flag : {"--max-sessions", "--max-body-bytes", "--max-memory-bytes",
                             "--max-crossings", "--max-edit-seconds"}) {
        EXPECT_EQ(exit_code({"serve", flag, "-5"}), kExitUsage) << flag;
    }
    EXPECT_EQ(exit_code({"serve", "--max-edit-seconds", "nan"}), kExitUsage);
}

TEST(CommandLine, ReadsServe) {
    EXPECT_EQ(serve({}).http.port, 8080);
    EXPECT_EQ(serve({}).http.host, "127.0.0.1");
    const ServeConfig config = serve({"--port", "0", "--port-file", "p", "--demo",
                                      "--max-body-bytes", "2MB", "--log-level", "error"});
    EXPECT_EQ(config.http.port, 0);
    EXPECT_EQ(config.port_file, "p");
    EXPECT_TRUE(config.demo);
    EXPECT_EQ(config.http.limits.max_body_bytes, 2U << 20);
    EXPECT_EQ(config.log_level, LogLevel::Error);
}

TEST(CommandLine, ReadsHowToLogAndHowToStop) {
    EXPECT_EQ(serve({}).log_format, LogFormat::Auto);
    EXPECT_DOUBLE_EQ(serve({}).grace, 10.0);
    EXPECT_DOUBLE_EQ(serve({}).drain_delay, 0.0);
    const ServeConfig config =
        serve({"--log-format", "JSON", "--grace", "2.5", "--drain-delay", "3"});
    EXPECT_EQ(config.log_format, LogFormat::Json);
    EXPECT_DOUBLE_EQ(config.grace, 2.5);
    EXPECT_DOUBLE_EQ(config.drain_delay, 3.0);
    for (const char* wrong : {"-1", "nan", "1e9", "soon"})
        EXPECT_EQ(exit_code({"serve", "--grace", wrong}), kExitUsage) << wrong;
    EXPECT_EQ(exit_code({"serve", "--log-format", "xml"}), kExitUsage);
    ::setenv("TINSMITH_GRACE", "4", 1);
    EXPECT_DOUBLE_EQ(serve({}).grace, 4.0);
    ::unsetenv("TINSMITH_GRACE");
}

TEST(CommandLine, ReadsIntegrate) {
    const Command command = parse({"integrate", "t.tif", "p.json", "-o", "out.glb", "--improve",
                                   "none", "--dry-run", "true", "--tolerance", "0.1"});
    const auto& config = std::get<IntegrateConfig>(command);
    EXPECT_EQ(config.terrain, "t.tif");
    EXPECT_EQ(config.polygons, "p.json");
    EXPECT_EQ(config.output, "out.glb");
    ASSERT_EQ(config.polygon_options.size(), 2U);
    EXPECT_EQ(config.polygon_options[0].name, "improve");
    EXPECT_EQ(config.polygon_options[0].value, "none");
    EXPECT_EQ(config.polygon_options[1].name, "dry_run");
    ASSERT_EQ(config.mesh_options.size(), 1U);
    EXPECT_EQ(config.mesh_options[0].value, "0.1");
}

TEST(CommandLine, TakesEveryOptionOfThePolygonsRequest) {
    for (const std::string_view name : api::polygon_option_names()) {
        std::string flag = "--" + std::string(name);
        std::replace(flag.begin(), flag.end(), '_', '-');
        const Command command =
            parse({"integrate", "t.tif", "p.json", "-o", "out.glb", flag.c_str(), "x"});
        ASSERT_TRUE(std::holds_alternative<IntegrateConfig>(command)) << flag;
        EXPECT_EQ(std::get<IntegrateConfig>(command).polygon_options.at(0).name, name);
    }
}

TEST(CommandLine, TakesTheEnvironmentToo) {
    ::setenv("TINSMITH_PORT", "9001", 1);
    ::setenv("TINSMITH_MAX_SESSIONS", "3", 1);
    const ServeConfig config = serve({"--max-sessions", "4"});
    ::unsetenv("TINSMITH_PORT");
    ::unsetenv("TINSMITH_MAX_SESSIONS");
    EXPECT_EQ(config.http.port, 9001);
    EXPECT_EQ(config.http.limits.max_sessions, 4U);
}

TEST(CommandLine, TellsOfNoMoreRequestsThanThreads) {
    const auto max_requests = [](std::initializer_list<const char*> arguments) {
        return serve(arguments).http.limits.max_requests;
    };
    EXPECT_EQ(max_requests({}), HttpOptions{}.threads);
    EXPECT_EQ(max_requests({"--threads", "4"}), 4U);
    EXPECT_EQ(max_requests({"--max-requests", "64"}), HttpOptions{}.threads);
    EXPECT_EQ(max_requests({"--max-requests", "5"}), 5U);
    EXPECT_EQ(max_requests({"--max-requests", "64", "--threads", "48"}), 48U);
}

TEST(CommandLine, HasAFlagForEveryLimit) {
    const auto value_of = [](const ServeConfig& config, const std::string& name) {
        Services services(config.http.limits);
        const Router router(make_routes(services));
        Request request;
        request.method = "GET";
        request.path = "/v1/limits";
        return nlohmann::json::parse(router.handle(request).body)[name].get<double>();
    };
    const auto described = nlohmann::json::parse(
        api::openapi_document())["components"]["schemas"]["Limits"]["required"];
    ASSERT_GT(described.size(), 20U);
    for (const auto& item : described) {
        const auto name = item.get<std::string>();
        SCOPED_TRACE(name);
        std::string flag = "--" + name;
        std::string variable = "TINSMITH_" + name;
        for (char& c : flag)
            c = c == '_' ? '-' : c;
        for (char& c : variable)
            c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        EXPECT_EQ(value_of(serve({flag.c_str(), "7"}), name), 7);
        ::setenv(variable.c_str(), "8", 1);
        const ServeConfig environment = serve({});
        ::unsetenv(variable.c_str());
        EXPECT_EQ(value_of(environment, name), 8);
        EXPECT_EQ(exit_code({"serve", flag.c_str(), "-1"}), kExitUsage);
        const TemporaryFile file("[serve]\n" + flag.substr(2) + " = 9\n");
        EXPECT_EQ(value_of(serve({"--config", file.path()}), name), 9);
    }
}

TEST(CommandLine, TakesAFileToo) {
    const TemporaryFile file("[serve]\nport = 9002\ndemo = true\nmax-sessions = 5\n");
    const ServeConfig config = serve({"--config", file.path(), "--max-sessions", "6"});
    EXPECT_EQ(config.http.port, 9002);
    EXPECT_TRUE(config.demo);
    EXPECT_EQ(config.http.limits.max_sessions, 6U);
}

TEST(CommandLine, ReadsWhoMayCallAndHow) {
    EXPECT_TRUE(serve({}).policy.cors_origins.empty());
    EXPECT_FALSE(serve({}).policy.require_if_match);
    const ServeConfig flags =
        serve({"--cors-origin", "https://a.example", "--cors-origin", "http://localhost:3000",
               "--require-if-match", "--mesh-cache", "1MB", "--kept-answers", "0"});
    EXPECT_EQ(flags.policy.cors_origins,
              (std::vector<std::string>{"https://a.example", "http://localhost:3000"}));
    EXPECT_TRUE(flags.policy.require_if_match);
    EXPECT_EQ(flags.http.limits.mesh_cache, 1U << 20);
    EXPECT_EQ(flags.http.limits.kept_answers, 0U);
    const TemporaryFile file(
        "[serve]\nrequire-if-match = true\ncors-origin = [\"https://a.example\", \"*\"]\n");
    const ServeConfig lines = serve({"--config", file.path()});
    EXPECT_TRUE(lines.policy.require_if_match);
    EXPECT_EQ(lines.policy.cors_origins, (std::vector<std::string>{"https://a.example", "*"}));
    ::setenv("TINSMITH_CORS_ORIGIN", "https://a.example,https://b.example", 1);
    ::setenv("TINSMITH_REQUIRE_IF_MATCH", "true", 1);
    const ServeConfig environment = serve({});
    ::unsetenv("TINSMITH_CORS_ORIGIN");
    ::unsetenv("TINSMITH_REQUIRE_IF_MATCH");
    for (const char* bad : {"TINSMITH_MAX_SESSIONS", "TINSMITH_MAX_BODY_BYTES", "TINSMITH_PORT",
                            "TINSMITH_CORS_ORIGIN", "TINSMITH_LOG_LEVEL"}) {
        ::setenv(bad, "https://a.example,-5", 1);
        EXPECT_EQ(exit_code({"serve"}), kExitUsage) << bad;
        ::unsetenv(bad);
    }
    EXPECT_TRUE(environment.policy.require_if_match);
    EXPECT_EQ(environment.policy.cors_origins,
              (std::vector<std::string>{"https://a.example", "https://b.example"}));
    for (const char* bad : {"a.example", "https://a.example/", "https://", "null", "",
                            "https://*.example", "HTTPS://a.example"}) {
        EXPECT_EQ(exit_code({"serve", "--cors-origin", bad}), kExitUsage) << bad;
    }
}

TEST(CommandLine, ReadsWhereKeysAre) {
    EXPECT_EQ(key_file_of("", ""), "");
    EXPECT_EQ(key_file_of("", "/data"), "/data/keys");
    EXPECT_EQ(key_file_of("", "/data/"), "/data/keys");
    EXPECT_EQ(key_file_of("/etc/keys", "/data"), "/etc/keys");
    EXPECT_FALSE(serve({}).insecure);
    EXPECT_TRUE(serve({"--insecure"}).insecure);
    const TemporaryFile file("[serve]\nkeys = \"/etc/keys\"\nfirst-key = true\n");
    const ServeConfig lines = serve({"--config", file.path()});
    EXPECT_EQ(lines.keys, "/etc/keys");
    EXPECT_TRUE(lines.first_key);
    ::setenv("TINSMITH_KEYS", "/run/keys", 1);
    ::setenv("TINSMITH_INSECURE", "true", 1);
    const ServeConfig environment = serve({});
    const Command listing = parse({"key", "list"});
    ::unsetenv("TINSMITH_KEYS");
    ::unsetenv("TINSMITH_INSECURE");
    EXPECT_EQ(environment.keys, "/run/keys");
    EXPECT_TRUE(environment.insecure);
    EXPECT_EQ(std::get<KeyConfig>(listing).keys, "/run/keys");
    EXPECT_EQ(std::get<KeyConfig>(listing).action, KeyConfig::Action::List);
}

TEST(CommandLine, ReadsQuotasOfAKey) {
    // The server's own limits are no quotas of a key.
    ::setenv("TINSMITH_MAX_SESSIONS", "3", 1);
    const Command plain = parse({"key", "add", "alice", "--data", "/data"});
    ::unsetenv("TINSMITH_MAX_SESSIONS");
    EXPECT_EQ(std::get<KeyConfig>(plain).quotas, KeyQuotas{});
    EXPECT_EQ(std::get<KeyConfig>(plain).name, "alice");
    EXPECT_EQ(std::get<KeyConfig>(plain).action, KeyConfig::Action::Add);
    const Command all = parse({"key", "add", "alice", "--max-sessions", "0", "--max-memory-bytes",
                               "1GB", "--max-requests", "4", "--max-requests-per-second", "0.5"});
    EXPECT_EQ(std::get<KeyConfig>(all).quotas, (KeyQuotas{0, std::size_t{1} << 30, 4, 0.5}));
    const Command others =
        parse({"key", "add", "alice", "--max-history", "5", "--max-history-bytes", "1MB",
               "--max-points", "7", "--max-profile-crossings", "9", "--max-queued-jobs", "0"});
    EXPECT_EQ(std::get<KeyConfig>(others).quotas, (KeyQuotas{.max_history = 5,
                                                             .max_history_bytes = 1U << 20,
                                                             .max_points = 7,
                                                             .max_profile_crossings = 9,
                                                             .max_queued_jobs = 0}));
    EXPECT_EQ(exit_code({"key", "add", "alice", "--max-history", "0"}), kExitUsage);
    for (const char* bad : {"-1", "many", "nan", ""}) {
        EXPECT_EQ(exit_code({"key", "add", "alice", "--max-sessions", bad}), kExitUsage) << bad;
        EXPECT_EQ(exit_code({"key", "add", "alice", "--max-requests-per-second", bad}), kExitUsage)
            << bad;
    }
    EXPECT_EQ(exit_code({"key", "renew", "alice", "--max-sessions", "1"}), kExitUsage);
    EXPECT_EQ(exit_code({"key", "add"}), kExitUsage);
    EXPECT_EQ(exit_code({"key"}), kExitUsage);
}

TEST(CommandLine, RefusesAFileWithUnknownLines) {
    const TemporaryFile file("[serve]\nprot = 9002\n");
    EXPECT_EQ(exit_code({"serve", "--config", file.path()}), kExitUsage);
    EXPECT_EQ(exit_code({"serve", "--config", "/nowhere/at/all.toml"}), kExitUsage);
}

}  // namespace
}  // namespace tinsmith::server
