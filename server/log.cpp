// SPDX-License-Identifier: Apache-2.0
#include "server/log.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "api/problem.hpp"
#include "server/metrics/metrics.hpp"

namespace tinsmith::server {

namespace {

constexpr const char* kTextPattern = "%Y-%m-%dT%H:%M:%S.%e%z %^%l%$ %v";
constexpr const char* kJsonPattern = R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v})";

bool is_json = false;

/// Made on first use and never taken down: threads may log until the process ends.
spdlog::logger& logger() {
    static const auto kInstance = [] {
        auto made = std::make_shared<spdlog::logger>(
            "tinsmith", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
        made->set_pattern(kTextPattern);
        made->flush_on(spdlog::level::debug);
        return made;
    }();
    return *kInstance;
}

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::Debug:
            return spdlog::level::debug;
        case LogLevel::Info:
            return spdlog::level::info;
        case LogLevel::Warning:
            return spdlog::level::warn;
        case LogLevel::Error:
            return spdlog::level::err;
        case LogLevel::Off:
            return spdlog::level::off;
    }
    return spdlog::level::info;
}

LogLevel level_of(const Request& request, const Response& response) {
    static constexpr std::array<std::string_view, 3> kProbes{"/healthz", "/readyz", "/metrics"};
    static constexpr int kRefusals = 400;
    static constexpr int kServerErrors = 500;
    if (std::find(kProbes.begin(), kProbes.end(), request.path) != kProbes.end() &&
        (response.status < kRefusals || request.path == "/readyz")) {
        return LogLevel::Debug;
    }
    if (response.status == api::problem_status(api::ProblemType::Internal)) return LogLevel::Error;
    return response.status >= kServerErrors ? LogLevel::Warning : LogLevel::Info;
}

}  // namespace

void set_log_level(LogLevel level) {
    logger().set_level(spdlog_level(level));
}

void set_log_format(LogFormat format) {
    is_json =
        format == LogFormat::Json || (format == LogFormat::Auto && ::isatty(STDERR_FILENO) == 0);
    logger().set_pattern(is_json ? kJsonPattern : kTextPattern);
}

void log_event(LogLevel level, std::string_view event, std::string_view message,
               std::initializer_list<LogField> fields) {
    const auto at = spdlog_level(level);
    if (!logger().should_log(at)) return;
    if (!is_json) {
        logger().log(at, "{}{}", sanitized(message, kLongestLogText), text_members(fields));
        return;
    }
    std::vector<LogField> all{{"event", event}, {"message", message}};
    all.insert(all.end(), fields.begin(), fields.end());
    logger().log(at, "{}", json_members(all));
}

void log_request(const Request& request, const Response& response, double milliseconds) {
    const auto at = spdlog_level(level_of(request, response));
    if (!logger().should_log(at)) return;
    std::vector<LogField> fields{
        {"status", response.status},       {"bytes", bytes_sent(request, response)},
        {"bytes_in", request.body.size()}, {"ms", milliseconds},
        {"request", request.id},           {"client", request.remote_address}};
    if (!request.asker.name.empty()) fields.emplace_back("key", request.asker.name);
    if (!response.problem.empty()) fields.emplace_back("problem", response.problem);
    if (request.trace) {
        fields.emplace_back("trace", request.trace->trace_id);
        fields.emplace_back("span", request.trace->parent_id);
    }
    if (!is_json) {
        logger().log(at, "{} \"{}\"{}", sanitized(request.method), sanitized(request.path),
                     text_members(fields));
        return;
    }
    std::vector<LogField> all{
        {"event", "request"}, {"method", request.method}, {"path", request.path}};
    if (response.route != nullptr) all.emplace_back("route", response.route->pattern());
    all.insert(all.end(), fields.begin(), fields.end());
    logger().log(at, "{}", json_members(all));
}

std::size_t bytes_sent(const Request& request, const Response& response) {
    return request.method == "HEAD" ? 0 : response.sent().size();
}

}  // namespace tinsmith::server
