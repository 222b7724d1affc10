// SPDX-License-Identifier: Apache-2.0
// A server that is known by its name and comes back with another address, as a container that is
// made anew does.
#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/attack/bad_server.hpp"
#include "tests/attack/proxy.hpp"
#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {
namespace {

/// Tells every name's IPv4 address (RFC 1035), and that there is no other.
class NameServer {
  public:
    explicit NameServer(const std::string& address)
        : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        tell(address);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof place;
        auto* any = static_cast<sockaddr*>(static_cast<void*>(&place));
        ::bind(socket_, any, size);
        ::getsockname(socket_, any, &size);
        port_ = ntohs(place.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~NameServer() {
        ::shutdown(socket_, SHUT_RDWR);
        thread_.join();
        ::close(socket_);
    }
    NameServer(const NameServer&) = delete;
    NameServer& operator=(const NameServer&) = delete;

    int port() const { return port_; }
    void tell(const std::string& address) {
        const std::scoped_lock lock(mutex_);
        ::inet_pton(AF_INET, address.c_str(), address_.data());
    }

  private:
    static constexpr std::size_t kHead = 12;

    /// Empty: no question.
    std::string answer_to(const std::string& question) {
        // The name is labels with their lengths; a zero, the type and the class end the question.
        std::size_t end = kHead;
        while (end < question.size() && question[end] != 0)
            end += std::size_t{1} + static_cast<std::uint8_t>(question[end]);
        end += 5;
        if (end > question.size()) return {};
        const bool wants_address = question[end - 4] == 0 && question[end - 3] == 1;
        std::string answer = question.substr(0, 2);
        answer += {'\x81', '\x80', 0, 1, 0, static_cast<char>(wants_address ? 1 : 0), 0, 0, 0, 0};
        answer += question.substr(kHead, end - kHead);
        if (!wants_address) return answer;
        // The name again, an address, of the internet, for a second, with four bytes.
        answer += {'\xc0', static_cast<char>(kHead), 0, 1, 0, 1, 0, 0, 0, 1, 0, 4};
        const std::scoped_lock lock(mutex_);
        answer.append(address_.data(), address_.size());
        return answer;
    }

    void serve() {
        std::array<char, 2048> bytes{};
        for (;;) {
            sockaddr_in asker{};
            socklen_t size = sizeof asker;
            auto* any = static_cast<sockaddr*>(static_cast<void*>(&asker));
            const ssize_t got = ::recvfrom(socket_, bytes.data(), bytes.size(), 0, any, &size);
            // What is shut down is told of as nothing from nobody.
            if (got <= 0) return;
            const std::string answer =
                answer_to(std::string(bytes.data(), static_cast<std::size_t>(got)));
            ::sendto(socket_, answer.data(), answer.size(), MSG_NOSIGNAL, any, size);
        }
    }

    std::mutex mutex_;
    std::array<char, 4> address_{};
    int socket_ = -1;
    int port_ = 0;
    std::thread thread_;
};

TEST(EdgeNames, FindTheServerAtItsNewAddress) {
    if (Proxy::program().empty())
        GTEST_SKIP() << "haproxy is not installed (docker/packages/install.sh test)";
    NameServer names("127.0.0.1");
    BadServer before;
    const BadServer after("127.0.0.2", before.port());
    ASSERT_NE(after.port(), 0);
    const Proxy proxy(
        "tinsmith.test:" + std::to_string(before.port()),
        {{"parse-resolv-conf", "nameserver test 127.0.0.1:" + std::to_string(names.port())},
         {"init-addr last,libc,none", "init-addr none"}});
    ASSERT_NE(proxy.port(), 0) << proxy.output();
    EXPECT_EQ(ask(proxy.port(), "GET", "/v1/limits").status, 200);

    before.stop();
    names.tell("127.0.0.2");
    // Both of what it is asked for by turns: each kind of requests has found it.
    int found = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (found < 2 && std::chrono::steady_clock::now() < end) {
        const char* const target = found == 0 ? "/v1/limits" : "/v1/sessions/a/mesh.glb";
        if (ask(proxy.port(), "GET", target).status == 200) {
            ++found;
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }
    EXPECT_EQ(found, 2) << proxy.output();
}

}  // namespace
}  // namespace tinsmith::e2e
