// SPDX-License-Identifier: Apache-2.0
#include "server/http/connection.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "server/http/request_head.hpp"

namespace tinsmith::server {

namespace {

using std::chrono::milliseconds;

/// More than this is not kept for a connection that has used what it read.
constexpr std::size_t kKeptCapacity = 4096;

using NameOf = int (*)(int, sockaddr*, socklen_t*);

Endpoint endpoint_of(int socket, NameOf name_of) {
    sockaddr_storage storage{};
    socklen_t size = sizeof storage;
    if (name_of(socket, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return {};
    std::array<char, INET6_ADDRSTRLEN> text{};
    const void* address = nullptr;
    in_port_t port = 0;
    if (storage.ss_family == AF_INET) {
        const auto* v4 = reinterpret_cast<const sockaddr_in*>(&storage);
        address = &v4->sin_addr;
        port = v4->sin_port;
    } else if (storage.ss_family == AF_INET6) {
        const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&storage);
        address = &v6->sin6_addr;
        port = v6->sin6_port;
    }
    if (address == nullptr || !::inet_ntop(storage.ss_family, address, text.data(), text.size()))
        return {};
    return {text.data(), ntohs(port)};
}

bool is_passing(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

Connection::Connection(int socket, ConnectionTotals& totals) : socket_(socket), totals_(totals) {
    ++totals_.connections;
    const int yes = 1;  // off by default, which costs 40 ms a request
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    // Without it the kernel takes megabytes of an answer, and says that there is room again once a
    // third of them has left: a client that reads slowly would seem to read nothing.
    const int most_unsent = 64 << 10;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most_unsent, sizeof most_unsent);
}

Connection::~Connection() {
    ::close(socket_);
    --totals_.connections;
}

Endpoint Connection::remote() const {
    return endpoint_of(socket_, ::getpeername);
}

Endpoint Connection::local() const {
    return endpoint_of(socket_, ::getsockname);
}

Connection::Got Connection::receive(std::size_t most) {
    std::array<char, 16384> bytes;  // NOLINT: left as it is, since it is written before it is read
    const ssize_t got = ::recv(socket_, bytes.data(), std::min(most, bytes.size()), MSG_DONTWAIT);
    if (got > 0) {
        // A fresh text where some was used up: the old one may have grown, and would be kept.
        if (used_ > 0) buffer_ = std::string(unread());
        used_ = 0;
        buffer_.append(bytes.data(), static_cast<std::size_t>(got));
        return Got::Bytes;
    }
    return got < 0 && is_passing(errno) ? Got::Nothing : Got::End;
}

void Connection::use(std::size_t count) {
    used_ += count;
    looked_at_ = 0;
    if (used_ < buffer_.size()) return;
    used_ = 0;
    buffer_.clear();
    if (buffer_.capacity() > kKeptCapacity) buffer_ = {};
}

void Connection::cut(std::size_t begin, std::size_t count) {
    buffer_.erase(used_ + begin, count);
    looked_at_ = 0;
}

std::size_t Connection::size_of_head() {
    while (unread().starts_with("\r\n"))
        use(2);
    const std::size_t size = server::size_of_head(unread(), looked_at_);
    if (size == 0) looked_at_ = unread().size();
    return size;
}

bool Connection::wait_for(short events, milliseconds longest) const {
    pollfd one{socket_, events, 0};
    const auto end = std::chrono::steady_clock::now() + longest;
    for (milliseconds left = longest;;) {
        const int ready = ::poll(&one, 1, static_cast<int>(left.count()));
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
        left = std::max(milliseconds(0),
                        std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now()));
    }
}

bool Connection::has_more() const {
    char byte = 0;
    return ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

bool Connection::wait_readable(milliseconds longest) const {
    return wait_for(POLLIN, longest);
}

long Connection::read(char* to, std::size_t most, milliseconds longest) {
    if (const std::string_view here = unread(); !here.empty()) {
        const std::size_t count = std::min(most, here.size());
        std::memcpy(to, here.data(), count);
        use(count);
        return static_cast<long>(count);
    }
    for (;;) {
        const ssize_t got = ::recv(socket_, to, most, MSG_DONTWAIT);
        if (got >= 0) return got;
        if (!is_passing(errno) || !wait_for(POLLIN, longest)) return -1;
    }
}

long Connection::write(std::string_view first, std::string_view second, milliseconds longest) {
    // The interface is older than const; it only reads.
    std::array<iovec, 2> parts{iovec{const_cast<char*>(first.data()), first.size()},
                               iovec{const_cast<char*>(second.data()), second.size()}};
    msghdr message{};
    message.msg_iov = parts.data();
    message.msg_iovlen = parts.size();
    for (;;) {
        const ssize_t sent = ::sendmsg(socket_, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent > 0) return sent;
        if (sent < 0 && !is_passing(errno)) return -1;
        if (!wait_for(POLLOUT, longest)) return -1;
    }
}

void Connection::end_sending() const {
    ::shutdown(socket_, SHUT_WR);
}

Connection::Got Connection::discard() {
    use(unread().size());
    const ssize_t got = ::recv(socket_, nullptr, std::size_t{1} << 20, MSG_DONTWAIT | MSG_TRUNC);
    if (got > 0) return Got::Bytes;
    return got < 0 && is_passing(errno) ? Got::Nothing : Got::End;
}

}  // namespace tinsmith::server
