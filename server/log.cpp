// SPDX-License-Identifier: Apache-2.0
#include "server/log.hpp"

#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace tinsmith::server {

namespace {

/// Made on first use and never taken down: threads may log until the process ends.
spdlog::logger& logger() {
    static const auto kInstance = [] {
        auto made = std::make_shared<spdlog::logger>(
            "tinsmith", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
        made->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %^%l%$ %v");
        made->flush_on(spdlog::level::info);
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

}  // namespace

void set_log_level(LogLevel level) {
    logger().set_level(spdlog_level(level));
}

void log_info(std::string_view text) {
    logger().info("{}", text);
}

void log_warning(std::string_view text) {
    logger().warn("{}", text);
}

void log_error(std::string_view text) {
    logger().error("{}", sanitized(text));
}

void log_request(const Request& request, const Response& response, double milliseconds) {
    const auto level = response.status >= 500 ? spdlog::level::err : spdlog::level::info;
    const std::string trace =
        request.trace ? " trace=" + request.trace->trace_id + " span=" + request.trace->parent_id
                      : std::string();
    logger().log(level, "{} \"{}\" status={} bytes={} ms={:.2f} request={} client={}{}",
                 sanitized(request.method), sanitized(request.path), response.status,
                 response.body.size(), milliseconds, request.id, sanitized(request.remote_address),
                 trace);
}

std::string sanitized(std::string_view text) {
    static constexpr std::size_t kLongest = 200;
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string out;
    for (const char c : text.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f && c != '"' && c != '\\') {
            out.push_back(c);
        } else {
            out += "\\x";
            out.push_back(kDigits[byte >> 4]);
            out.push_back(kDigits[byte & 15U]);
        }
    }
    if (text.size() > kLongest) out += "...";
    return out;
}

}  // namespace tinsmith::server
