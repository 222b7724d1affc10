// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/http_peers.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tinsmith::bench {

Program::Program(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("no process can be started");
    if (pid_ > 0) return;
    execvp(arguments[0], arguments.data());
    _exit(127);
}

Program::~Program() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
}

bool Program::is_running() {
    return waitpid(pid_, nullptr, WNOHANG) == 0;
}

std::size_t Program::resident_bytes() const {
    std::ifstream in("/proc/" + std::to_string(pid_) + "/statm");
    std::size_t all = 0, resident = 0;
    if (!(in >> all >> resident)) throw std::runtime_error("the program ended");
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t Program::peak_bytes() const {
    std::ifstream in("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("VmHWM:")) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
    }
    throw std::runtime_error("the program ended");
}

Connection::Connection(int port) : port_(port) {
    open();
}

void Connection::open() {
    if (socket_ >= 0) close(socket_);
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    const int on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error("nobody listens on port " + std::to_string(port_));
}

Connection::~Connection() {
    close(socket_);
}

const Answer& Connection::ask(std::string_view method, std::string_view path,
                              std::string_view headers, std::string_view body) {
    request_.assign(method).append(" ").append(path).append(" HTTP/1.1\r\nHost: 127.0.0.1\r\n");
    request_.append(headers);
    if (!body.empty()) request_ += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    request_.append("\r\n").append(body);
    for (std::size_t sent = 0; sent < request_.size();) {
        const ssize_t some = send(socket_, request_.data() + sent, request_.size() - sent, 0);
        if (some <= 0) throw std::runtime_error("the connection was closed");
        sent += static_cast<std::size_t>(some);
    }
    head_.clear();
    std::size_t end = std::string::npos;
    while (end == std::string::npos) {
        char some[16384];
        const ssize_t got = recv(socket_, some, sizeof some, 0);
        if (got <= 0) throw std::runtime_error("the connection was closed");
        head_.append(some, static_cast<std::size_t>(got));
        end = head_.find("\r\n\r\n");
    }
    std::string names = head_.substr(0, end);
    std::ranges::transform(names, names.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::size_t length = names.find("\r\ncontent-length:");
    if (length == std::string::npos && names.find("\r\ntransfer-encoding:") != std::string::npos)
        throw std::runtime_error("the answer has no Content-Length");
    answer_.status = std::atoi(head_.c_str() + head_.find(' '));
    answer_.body.resize(
        length == std::string::npos ? 0 : std::strtoull(names.c_str() + length + 17, nullptr, 10));
    std::size_t filled = std::min(head_.size() - end - 4, answer_.body.size());
    std::copy_n(head_.begin() + static_cast<std::ptrdiff_t>(end) + 4, filled, answer_.body.begin());
    while (filled < answer_.body.size()) {
        const ssize_t got =
            recv(socket_, answer_.body.data() + filled, answer_.body.size() - filled, 0);
        if (got <= 0) throw std::runtime_error("the connection was closed");
        filled += static_cast<std::size_t>(got);
    }
    if (names.find("\r\nconnection: close") != std::string::npos) open();
    return answer_;
}

int port_in(const std::string& file, Program& program) {
    for (int tries = 0; tries < 600; ++tries) {
        int port = 0;
        if (std::ifstream(file) >> port && port > 0) return port;
        if (!program.is_running()) throw std::runtime_error("the program ended");
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    throw std::runtime_error("the program does not serve");
}

}  // namespace tinsmith::bench
