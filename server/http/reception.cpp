// SPDX-License-Identifier: Apache-2.0
#include "server/http/reception.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/http/request_head.hpp"

namespace tinsmith::server {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Other threads put connections into lines without waking this one, which looks this often.
constexpr milliseconds kTick{200};
/// While it takes no connections since there are too many.
constexpr milliseconds kTickWhenFull{20};
/// Connections taken before the others are looked at again.
constexpr int kAcceptedAtOnce = 64;

void watch(int events, int operation, int socket, std::uint32_t what) {
    epoll_event event{};
    event.events = what;
    event.data.fd = socket;
    ::epoll_ctl(events, operation, socket, &event);
}

constexpr std::uint32_t kOnce = EPOLLIN | EPOLLRDHUP | EPOLLONESHOT;
/// Known to the instance, and not looked at: a hang-up is told once, and of nobody who waits.
constexpr std::uint32_t kNotYet = EPOLLONESHOT;

/// For answers that are written while the server stops.
constexpr milliseconds kPartingAtTheEnd{100};

}  // namespace

Reception::Reception(int listener, ReceptionOptions options, ConnectionTotals& totals,
                     Receive receive)
    : options_(options),
      receive_(std::move(receive)),
      totals_(totals),
      listener_(listener),
      events_(::epoll_create1(EPOLL_CLOEXEC)),
      waker_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    ::fcntl(listener_, F_SETFL, ::fcntl(listener_, F_GETFL) | O_NONBLOCK);
    watch(events_, EPOLL_CTL_ADD, waker_, EPOLLIN);
    watch(events_, EPOLL_CTL_ADD, listener_, 0);
    listen(true);
}

Reception::~Reception() {
    stop();
    for (Line& each : lines_)
        each.clear();
    for (const int descriptor : {listener_, waker_, events_})
        if (descriptor >= 0) ::close(descriptor);
}

void Reception::listen(bool wanted) {
    if (wanted == listening_) return;
    watch(events_, EPOLL_CTL_MOD, listener_, wanted ? EPOLLIN : 0U);
    listening_ = wanted;
}

milliseconds Reception::longest(Wait wait) const {
    switch (wait) {
        case Wait::Parting:
            return options_.parting;
        case Wait::Idle:
            return options_.idle;
        case Wait::First:
        case Wait::Head:
            break;
    }
    return options_.head;
}

bool Reception::run() {
    std::array<epoll_event, 128> events{};
    std::vector<Arrival> arrived;
    while (!stopping_ && !failed_) {
        const int count =
            ::epoll_wait(events_, events.data(), static_cast<int>(events.size()), next_look());
        if (count < 0 && errno != EINTR) failed_ = true;
        {
            const std::lock_guard lock(mutex_);
            for (int i = 0; i < count && !stopping_; ++i) {
                const int socket = events[static_cast<std::size_t>(i)].data.fd;
                if (socket == listener_) {
                    accept_all(arrived);
                } else if (const auto found = places_.find(socket); found != places_.end()) {
                    look_at(found->second, arrived);
                }
            }
            end_waits(arrived);
            listen(totals_.connections < options_.max_connections);
        }
        for (Arrival& each : arrived)
            receive_(std::move(each));
        arrived.clear();
    }
    const std::lock_guard lock(mutex_);
    closed_ = true;
    ::close(std::exchange(listener_, -1));
    places_.clear();
    for (Line& each : lines_)
        each.clear();
    return !failed_;
}

void Reception::stop() {
    stopping_ = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(waker_, &one, sizeof one);
}

int Reception::next_look() const {
    if (!listening_) return static_cast<int>(kTickWhenFull.count());
    return totals_.connections == 0 ? -1 : static_cast<int>(kTick.count());
}

Reception::Place Reception::enter(std::unique_ptr<Connection> connection, Wait wait) {
    Line& all = line(wait);
    const int socket = connection->socket();
    all.push_back({std::move(connection), wait, Clock::now()});
    const Place place = std::prev(all.end());
    places_.emplace(socket, place);
    return place;
}

std::unique_ptr<Connection> Reception::enter_unless_closed(std::unique_ptr<Connection> connection,
                                                           Wait wait) {
    const std::lock_guard lock(mutex_);
    if (closed_) return connection;
    const Place place = enter(std::move(connection), wait);
    watch(events_, EPOLL_CTL_MOD, place->connection->socket(), kOnce);
    return nullptr;
}

std::unique_ptr<Connection> Reception::leave(Place place) {
    std::unique_ptr<Connection> connection = std::move(place->connection);
    places_.erase(connection->socket());
    line(place->wait).erase(place);
    return connection;
}

void Reception::move_to(Place place, Wait wait) {
    Line& from = line(place->wait);
    place->wait = wait;
    place->since = Clock::now();
    Line& to = line(wait);
    to.splice(to.end(), from, place);
}

bool Reception::send_one_away() {
    for (Line& each : lines_) {
        if (each.empty()) continue;
        send_away(each.begin());
        return true;
    }
    return false;
}

void Reception::send_away(Place place) {
    leave(place);
    ++totals_.sent_away;
}

void Reception::keep(std::unique_ptr<Connection> connection) {
    const Wait wait = connection->unread().empty() ? Wait::Idle : Wait::Head;
    enter_unless_closed(std::move(connection), wait);
}

void Reception::part(std::unique_ptr<Connection> connection) {
    connection->end_sending();
    if (!connection->discard()) return;
    connection = enter_unless_closed(std::move(connection), Wait::Parting);
    if (connection && connection->wait_readable(kPartingAtTheEnd)) connection->discard();
}

void Reception::accept_all(std::vector<Arrival>& arrived) {
    for (int i = 0; i < kAcceptedAtOnce; ++i)
        if (!accept_one(arrived)) return;
}

/// False: there is none, or no room for one.
bool Reception::accept_one(std::vector<Arrival>& arrived) {
    const bool is_full = totals_.connections >= options_.max_connections;
    if (is_full && places_.empty()) return false;
    int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0 && (errno == EMFILE || errno == ENFILE)) {
        if (!send_one_away()) {
            listen(false);
            return false;
        }
        socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    }
    if (socket < 0) {
        failed_ = errno == EBADF || errno == EINVAL || errno == ENOTSOCK;
        return errno == ECONNABORTED || errno == EINTR;
    }
    if (is_full) send_one_away();
    const Place place = enter(std::make_unique<Connection>(socket, totals_), Wait::First);
    watch(events_, EPOLL_CTL_ADD, socket, kNotYet);
    look_at(place, arrived);
    return true;
}

void Reception::look_at(Place place, std::vector<Arrival>& arrived) {
    Connection& connection = *place->connection;
    if (place->wait == Wait::Parting) {
        if (connection.discard()) {
            watch(events_, EPOLL_CTL_MOD, connection.socket(), kOnce);
        } else {
            leave(place);
        }
        return;
    }
    switch (connection.receive(kMaxHeadBytes)) {
        case Connection::Got::End:
            leave(place);
            return;
        case Connection::Got::Bytes:
            look_at_bytes(place, arrived);
            return;
        case Connection::Got::Nothing:
            break;
    }
    watch(events_, EPOLL_CTL_MOD, connection.socket(), kOnce);
}

void Reception::look_at_bytes(Place place, std::vector<Arrival>& arrived) {
    Connection& connection = *place->connection;
    const std::size_t size = connection.size_of_head();
    if (size > kMaxHeadBytes || (size == 0 && connection.unread().size() > kMaxHeadBytes)) {
        arrived.push_back({leave(place), Arrival::State::TooLarge});
        return;
    }
    if (size > 0) {
        arrived.push_back({leave(place), Arrival::State::Whole});
        return;
    }
    if (place->wait != Wait::Head) move_to(place, Wait::Head);
    watch(events_, EPOLL_CTL_MOD, connection.socket(), kOnce);
    Line& heads = line(Wait::Head);
    while (totals_.unread_bytes > options_.max_unread_bytes && !heads.empty())
        send_away(heads.begin());
}

void Reception::end_waits(std::vector<Arrival>& arrived) {
    const Time now = Clock::now();
    for (Line& each : lines_) {
        while (!each.empty() && now - each.front().since >= longest(each.front().wait)) {
            const bool is_late = each.front().wait == Wait::Head;
            std::unique_ptr<Connection> connection = leave(each.begin());
            if (is_late) arrived.push_back({std::move(connection), Arrival::State::Late});
        }
    }
}

}  // namespace tinsmith::server
