// SPDX-License-Identifier: Apache-2.0
#include "server/http/plain_answer.hpp"

#include <algorithm>

#include "server/limits.hpp"

namespace tinsmith::server {

namespace {

constexpr std::size_t kLongestMethod = 16;

bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}

bool is_visible(char c) {
    return c > 0x20 && c < 0x7F;
}

}  // namespace

Request request_of_bytes(std::string_view bytes) {
    Request request;
    request.method = "-";
    const std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    const std::size_t space = line.find(' ');
    const std::string_view method = line.substr(0, space);
    if (method.empty() || method.size() > kLongestMethod || space == std::string_view::npos ||
        !std::all_of(method.begin(), method.end(), is_upper))
        return request;
    request.method = method;
    const std::string_view target = line.substr(space + 1);
    const std::string_view path = target.substr(0, target.find_first_of(" ?#"));
    if (path.size() <= kMaxPathBytes && std::all_of(path.begin(), path.end(), is_visible))
        request.path = path;
    return request;
}

std::string write_last_answer(const Response& response, std::string_view title, bool with_body) {
    std::string text = "HTTP/1.1 " + std::to_string(response.status) + " ";
    text.append(title);
    for (const auto& [name, value] : response.headers)
        text.append("\r\n").append(name).append(": ").append(value);
    text += "\r\nContent-Type: " + response.content_type +
            "\r\nContent-Length: " + std::to_string(response.body.size()) +
            "\r\nConnection: close\r\n\r\n";
    if (with_body) text += response.body;
    return text;
}

}  // namespace tinsmith::server
