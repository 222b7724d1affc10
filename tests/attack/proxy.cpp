// SPDX-License-Identifier: Apache-2.0
#include "tests/attack/proxy.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

namespace {

/// One that nobody has at this moment. HAProxy cannot say which it has chosen by itself.
int free_port() {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = static_cast<sockaddr*>(static_cast<void*>(&address));
    ::bind(socket, any, size);
    ::getsockname(socket, any, &size);
    ::close(socket);
    return ntohs(address.sin_port);
}

/// Nothing, where one of the texts is not there.
std::string changed(std::string text, const Proxy::Changes& changes) {
    for (const auto& [from, to] : changes) {
        const std::size_t found = text.find(from);
        if (found == std::string::npos) return {};
        text.replace(found, from.size(), to);
    }
    return text;
}

[[noreturn]] void become_proxy(const std::string& program, const std::string& configuration,
                               int port, const std::string& server, int output) {
    const std::string at = std::to_string(port);
    ::setenv("TINSMITH_EDGE_PORT", at.c_str(), 1);
    ::setenv("TINSMITH_SERVER", server.c_str(), 1);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execl(program.c_str(), program.c_str(), "-db", "-f", configuration.c_str(), nullptr);
    ::_exit(127);
}

}  // namespace

std::string Proxy::program() {
    for (const char* place : {"/usr/sbin/haproxy", "/usr/local/sbin/haproxy", "/usr/bin/haproxy"})
        if (std::filesystem::exists(place)) return place;
    return {};
}

Proxy::Proxy(int server_port, const Changes& changes)
    : Proxy("127.0.0.1:" + std::to_string(server_port), changes) {}

Proxy::Proxy(const std::string& server, const Changes& changes) : output_(scratch_.file("proxy")) {
    const std::string configuration = scratch_.file("haproxy.cfg");
    write_content(configuration,
                  changed(content_of(TINSMITH_SOURCE_DIR "/docker/haproxy.cfg"), changes));
    const int port = free_port();
    const int file = ::open(output_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
    pid_ = ::fork();
    if (pid_ == 0) become_proxy(program(), configuration, port, server, file);
    ::close(file);
    // It takes the server for sound until a check says otherwise, so one good answer is enough.
    for (int i = 0; i < 500 && port_ == 0 && is_running(); ++i) {
        if (ask(port, "GET", "/readyz").status == 200) port_ = port;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

Proxy::~Proxy() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
}

bool Proxy::is_running() const {
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid == 0;
}

}  // namespace tinsmith::e2e
