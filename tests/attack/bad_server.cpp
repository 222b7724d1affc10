// SPDX-License-Identifier: Apache-2.0
#include "tests/attack/bad_server.hpp"

#include <array>
#include <cstdint>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tinsmith::e2e {

namespace {

const std::string kReady = "HTTP/1.1 200 OK\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

}  // namespace

BadServer::BadServer(const std::string& address, int port)
    : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, address.c_str(), &place.sin_addr);
    socklen_t size = sizeof place;
    auto* any = static_cast<sockaddr*>(static_cast<void*>(&place));
    if (::bind(listener_, any, size) != 0 || ::listen(listener_, 100) != 0) return;
    ::getsockname(listener_, any, &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { serve(); });
}

void BadServer::stop() {
    if (!thread_.joinable()) return;
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
    for (const int each : held_)
        ::close(each);
}

void BadServer::serve() {
    for (;;) {
        const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (client < 0) return;
        std::array<char, 4096> bytes{};
        std::string head;
        while (head.find("\r\n\r\n") == std::string::npos) {
            const ssize_t got = ::recv(client, bytes.data(), bytes.size(), 0);
            if (got <= 0) break;
            head.append(bytes.data(), static_cast<std::size_t>(got));
        }
        if (head.find(" /v1/hangs") != std::string::npos) {
            held_.push_back(client);
            continue;
        }
        std::string answer = kReady;
        if (head.find(" /v1/closes") != std::string::npos) answer.clear();
        if (head.find(" /v1/babbles") != std::string::npos) answer = "nonsense\r\n\r\n";
        ::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
        ::close(client);
    }
}

}  // namespace tinsmith::e2e
