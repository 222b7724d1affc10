// SPDX-License-Identifier: Apache-2.0
#include "server/http/listener.hpp"

#include <cerrno>
#include <cstring>
#include <memory>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tinsmith::server {

namespace {

/// Connections that the kernel holds until they are taken.
constexpr int kBacklog = 1024;

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

/// -1 with `errno` where it fails.
int listen_on(const addrinfo& address) {
    const int socket =
        ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, address.ai_protocol);
    if (socket < 0) return -1;
    // After a restart the port is still held by connections that end; SO_REUSEPORT would share it.
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (::bind(socket, address.ai_addr, address.ai_addrlen) == 0 && ::listen(socket, kBacklog) == 0)
        return socket;
    const int error = errno;
    ::close(socket);
    errno = error;
    return -1;
}

int port_of(int socket) {
    sockaddr_storage storage{};
    socklen_t size = sizeof storage;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return 0;
    return ntohs(storage.ss_family == AF_INET6
                     ? reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_port
                     : reinterpret_cast<const sockaddr_in*>(&storage)->sin_port);
}

}  // namespace

Listener listen_on(const std::string& host, int port) {
    addrinfo wish{};
    wish.ai_family = AF_UNSPEC;
    wish.ai_socktype = SOCK_STREAM;
    wish.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo* found = nullptr;
    const std::string where = "cannot listen on " + host + ":" + std::to_string(port) + ": ";
    if (const int code = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wish, &found);
        code != 0) {
        return {-1, 0, where + "no such address (" + ::gai_strerror(code) + ")"};
    }
    const Addresses addresses(found, ::freeaddrinfo);
    int error = 0;
    for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
        const int socket = listen_on(*each);
        if (socket >= 0) return {socket, port_of(socket), {}};
        error = errno;
    }
    return {-1, 0,
            where + std::strerror(error) +
                (error == EADDRINUSE ? " (another server is there; choose another --port)" : "")};
}

}  // namespace tinsmith::server
