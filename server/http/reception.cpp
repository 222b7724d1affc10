// SPDX-License-Identifier: Apache-2.0
#include "server/http/reception.hpp"

#include <algorithm>
#include <cerrno>
#include <new>
#include <utility>

#include <fcntl.h>
#include <poll.h>
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
/// While it takes no connections.
constexpr milliseconds kTickWhenPaused{20};
/// After the system had no memory or no descriptor for one, and nobody could make room.
constexpr milliseconds kPauseWithoutMemory{100};
/// Connections taken before the others are looked at again.
constexpr int kAcceptedAtOnce = 64;
/// Whether their request has come by now. They cost a system call each.
constexpr int kAskedBeforeOneGoes = 16;
/// So often at the end: as many as the kernel holds for a listener.
constexpr int kLastTurns = 16;

bool watch(int events, int operation, int socket, std::uint32_t what) {
    epoll_event event{};
    event.events = what;
    event.data.fd = socket;
    return ::epoll_ctl(events, operation, socket, &event) == 0;
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
            for (int i = 0; i < count && !stopping_; ++i)
                take_turn(events[static_cast<std::size_t>(i)].data.fd, arrived);
            end_waits(arrived);
            const bool has_room =
                totals_.connections < options_.max_connections || !places_.empty();
            listen(has_room && Clock::now() >= paused_until_);
        }
        hand_over(arrived);
    }
    {
        const std::lock_guard lock(mutex_);
        take_last_turn(arrived);
        closed_ = true;
    }
    hand_over(arrived);
    return !failed_;
}

/// One that has no memory loses its turn and its connection; the others go on.
// NOLINTNEXTLINE(misc-no-recursion): two deep, for the listener and for who came by it
void Reception::take_turn(int socket, std::vector<Arrival>& arrived) try {
    if (socket == listener_) {
        accept_all(arrived);
    } else if (const auto found = places_.find(socket); found != places_.end()) {
        look_at(found->second, arrived);
    }
} catch (const std::bad_alloc&) {
    if (const auto found = places_.find(socket); found != places_.end()) send_away(found->second);
    if (socket == listener_) pause(kPauseWithoutMemory);
}

/// What has come by now was sent in good faith.
void Reception::take_last_turn(std::vector<Arrival>& arrived) {
    for (int i = 0; i < kLastTurns && !failed_ && has_pending(); ++i)
        take_turn(listener_, arrived);
    ::close(std::exchange(listener_, -1));
    for (const Wait wait : {Wait::Idle, Wait::First, Wait::Head}) {
        while (!line(wait).empty()) {
            const int socket = line(wait).front().connection->socket();
            take_turn(socket, arrived);
            if (const auto found = places_.find(socket); found != places_.end())
                leave(found->second);
        }
    }
}

void Reception::hand_over(std::vector<Arrival>& arrived) {
    for (Arrival& each : arrived) {
        try {
            receive_(std::move(each));
        } catch (const std::bad_alloc&) {
            ++totals_.sent_away;
        }
    }
    arrived.clear();
}

void Reception::stop() {
    stopping_ = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(waker_, &one, sizeof one);
}

int Reception::next_look() const {
    if (!listening_) return static_cast<int>(kTickWhenPaused.count());
    return totals_.connections == 0 ? -1 : static_cast<int>(kTick.count());
}

Reception::Place Reception::enter(std::unique_ptr<Connection> connection, Wait wait) {
    const int socket = connection->socket();
    const std::size_t bytes = wait == Wait::Head ? connection->unread().size() : 0;
    const Time now = Clock::now();
    Line one;
    one.push_back({std::move(connection), wait, now, now, bytes});
    const Place place = one.begin();
    places_.emplace(socket, place);  // the last that may fail
    Line& all = line(wait);
    all.splice(all.end(), one);
    head_bytes_ += bytes;
    return place;
}

std::unique_ptr<Connection> Reception::enter_unless_closed(std::unique_ptr<Connection> connection,
                                                           Wait wait) {
    const std::lock_guard lock(mutex_);
    if (closed_) return connection;
    look_again(enter(std::move(connection), wait));
    return nullptr;
}

std::unique_ptr<Connection> Reception::leave(Place place) {
    std::unique_ptr<Connection> connection = std::move(place->connection);
    places_.erase(connection->socket());
    head_bytes_ -= place->bytes;
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

/// One of those that have waited longest, of whom nothing has come that nobody has looked at.
std::optional<Reception::Place> Reception::silent_in(Line& line) const {
    int left = kAskedBeforeOneGoes;
    for (Place place = line.begin(); place != line.end() && left > 0; ++place, --left) {
        const bool may_ask = place->wait == Wait::Idle || place->wait == Wait::First;
        if (!may_ask || !place->connection->has_more()) return place;
    }
    return std::nullopt;
}

bool Reception::send_one_away() {
    Line* first = nullptr;
    for (Line& each : lines_) {
        if (const auto place = silent_in(each)) {
            send_away(*place);
            return true;
        }
        if (first == nullptr && !each.empty()) first = &each;
    }
    if (first == nullptr) return false;
    send_away(first->begin());
    return true;
}

void Reception::send_away(Place place) {
    leave(place);
    ++totals_.sent_away;
}

std::unique_ptr<Connection> Reception::keep(std::unique_ptr<Connection> connection) {
    const Wait wait = connection->unread().empty() ? Wait::Idle : Wait::Head;
    return enter_unless_closed(std::move(connection), wait);
}

void Reception::part(std::unique_ptr<Connection> connection) {
    connection->end_sending();
    if (connection->discard() == Connection::Got::End) return;
    connection = enter_unless_closed(std::move(connection), Wait::Parting);
    if (connection && connection->wait_readable(kPartingAtTheEnd)) connection->discard();
}

// NOLINTNEXTLINE(misc-no-recursion): two deep, for the listener and for who came by it
void Reception::accept_all(std::vector<Arrival>& arrived) {
    for (int i = 0; i < kAcceptedAtOnce; ++i)
        if (!accept_one(arrived)) return;
}

/// False: there is none, or no room for one.
// NOLINTNEXTLINE(misc-no-recursion): two deep, for the listener and for who came by it
bool Reception::accept_one(std::vector<Arrival>& arrived) {
    const bool is_full = totals_.connections >= options_.max_connections;
    if (is_full && places_.empty()) return false;
    int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    // Told before anybody looks whether one is there.
    if (socket < 0 && errno == EMFILE && has_pending() && send_one_away())
        socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) {
        const int error = errno;
        failed_ = error == EBADF || error == EINVAL || error == ENOTSOCK;
        if (error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM)
            pause(kPauseWithoutMemory);
        return error == ECONNABORTED || error == EINTR;
    }
    if (is_full) send_one_away();
    std::unique_ptr<Connection> connection;
    try {
        connection = std::make_unique<Connection>(socket, totals_);
    } catch (const std::bad_alloc&) {
        ::close(socket);
        throw;
    }
    const Place place = enter(std::move(connection), Wait::First);
    if (!watch(events_, EPOLL_CTL_ADD, socket, kNotYet)) {
        send_away(place);
        return true;
    }
    take_turn(socket, arrived);
    return true;
}

bool Reception::has_pending() const {
    pollfd one{listener_, POLLIN, 0};
    return ::poll(&one, 1, 0) > 0;
}

void Reception::pause(milliseconds longest) {
    paused_until_ = Clock::now() + longest;
}

void Reception::look_again(Place place) {
    if (!watch(events_, EPOLL_CTL_MOD, place->connection->socket(), kOnce)) send_away(place);
}

void Reception::look_at(Place place, std::vector<Arrival>& arrived) {
    if (place->wait == Wait::Parting) {
        look_at_parting(place);
        return;
    }
    switch (place->connection->receive(kMaxHeadBytes)) {
        case Connection::Got::End:
            leave(place);
            return;
        case Connection::Got::Bytes:
            look_at_bytes(place, arrived);
            return;
        case Connection::Got::Nothing:
            break;
    }
    look_again(place);
}

void Reception::look_at_parting(Place place) {
    const Connection::Got got = place->connection->discard();
    if (got == Connection::Got::End || Clock::now() - place->begun > options_.longest_parting) {
        leave(place);
        return;
    }
    if (got == Connection::Got::Bytes) move_to(place, Wait::Parting);
    look_again(place);
}

void Reception::look_at_bytes(Place place, std::vector<Arrival>& arrived) {
    Connection& connection = *place->connection;
    const std::size_t size = connection.size_of_head();
    const std::size_t unread = connection.unread().size();
    if (size > kMaxHeadBytes || (size == 0 && unread > kMaxHeadBytes)) {
        arrived.push_back({leave(place), Arrival::State::TooLarge});
        return;
    }
    if (size > 0) {
        arrived.push_back({leave(place), Arrival::State::Whole});
        return;
    }
    if (unread > 0) {  // else it was an empty line between two requests
        if (place->wait != Wait::Head) move_to(place, Wait::Head);
        head_bytes_ += unread - place->bytes;
        place->bytes = unread;
    }
    look_again(place);
    Line& heads = line(Wait::Head);
    while (head_bytes_ > options_.max_head_bytes)
        send_away(heads.begin());
}

void Reception::end_waits(std::vector<Arrival>& arrived) try {
    const Time now = Clock::now();
    for (Line& each : lines_) {
        while (!each.empty() && now - each.front().since >= longest(each.front().wait)) {
            const bool is_late = each.front().wait == Wait::Head;
            std::unique_ptr<Connection> connection = leave(each.begin());
            if (is_late) arrived.push_back({std::move(connection), Arrival::State::Late});
        }
    }
} catch (const std::bad_alloc&) {
    ++totals_.sent_away;  // without a word; the others when it looks again
}

}  // namespace tinsmith::server
