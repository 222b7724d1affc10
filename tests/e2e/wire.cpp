// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/wire.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace tinsmith::e2e {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

void parse_head(std::string_view head, Answer& answer) {
    if (!head.starts_with("HTTP/1.1 ")) return;
    answer.status = std::atoi(std::string(head.substr(9, 3)).c_str());
    for (std::size_t at = head.find("\r\n"); at != std::string_view::npos;) {
        const std::size_t end = head.find("\r\n", at + 2);
        const std::string_view line = head.substr(at + 2, end - at - 2);
        const std::size_t colon = line.find(": ");
        if (colon != std::string_view::npos) {
            answer.headers[lower(std::string(line.substr(0, colon)))] = line.substr(colon + 2);
        }
        at = end;
    }
}

}  // namespace

Connection::Connection(int port, int longest_seconds)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval longest{longest_seconds, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &longest, sizeof longest);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto* any = static_cast<const sockaddr*>(static_cast<const void*>(&address));
    if (::connect(socket_, any, sizeof address) != 0) {
        ::close(socket_);
        socket_ = -1;
    }
}

Connection::~Connection() {
    if (socket_ >= 0) ::close(socket_);
}

void Connection::send(std::string_view bytes) const {
    try_send(bytes);
}

bool Connection::try_send(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

void Connection::end_sending() const {
    ::shutdown(socket_, SHUT_WR);
}

bool Connection::fill() {
    std::array<char, 65536> part{};
    std::size_t most = part.size();
    if (bytes_a_second_ > 0) {
        constexpr std::size_t kSteps = 50;
        most = std::min(most, bytes_a_second_ / kSteps);
        std::this_thread::sleep_for(std::chrono::milliseconds(1000 / kSteps));
    }
    const ssize_t got = ::recv(socket_, part.data(), most, 0);
    if (got <= 0) return false;
    buffer_.append(part.data(), static_cast<std::size_t>(got));
    return true;
}

Answer Connection::read(bool to_head) {
    Answer answer;
    std::size_t end = std::string::npos;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
        if (!fill()) return answer;
    }
    parse_head(std::string_view(buffer_).substr(0, end), answer);
    buffer_.erase(0, end + 4);
    const auto length =
        to_head ? 0 : static_cast<std::size_t>(std::atoll(answer.header("content-length").c_str()));
    while (buffer_.size() < length && fill()) {
    }
    answer.body = buffer_.substr(0, length);
    buffer_.erase(0, length);
    return answer;
}

bool Connection::is_closed() {
    if (!buffer_.empty()) return false;
    char byte = 0;
    const ssize_t got = ::recv(socket_, &byte, 1, 0);
    const bool is_reset = got < 0 && errno == ECONNRESET;
    return got == 0 || is_reset;
}

std::string request_text(const std::string& method, const std::string& target,
                         const std::vector<std::string>& headers, const std::string& body) {
    std::string text = method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n";
    for (const std::string& header : headers)
        text += header + "\r\n";
    const bool has_body = method == "POST" || method == "PUT" || method == "PATCH" || !body.empty();
    if (has_body) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return text + "\r\n" + body;
}

Answer ask(int port, const std::string& method, const std::string& target,
           const std::vector<std::string>& headers, const std::string& body) {
    Connection connection(port);
    connection.send(request_text(method, target, headers, body));
    return connection.read(method == "HEAD");
}

}  // namespace tinsmith::e2e
