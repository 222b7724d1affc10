// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "server/http/connection.hpp"

namespace tinsmith::server {

struct ReceptionOptions {
    std::size_t max_connections = 10'000;
    std::size_t max_head_bytes = std::size_t{8} << 20;  ///< of all heads that are not whole
    std::chrono::milliseconds head{10'000};             ///< for a whole head to arrive
    std::chrono::milliseconds idle{60'000};             ///< between two requests
    std::chrono::milliseconds parting{2'000};  ///< for a client to read the last answer, ...
    std::chrono::milliseconds longest_parting{10'000};  ///< ... also while it still sends
};

/// What came to the end of its wait.
struct Arrival {
    enum class State {
        Whole,     ///< a head is there
        TooLarge,  ///< it has grown too large
        Late,      ///< it has taken too long
    };
    std::unique_ptr<Connection> connection;
    State state = State::Whole;
};

/// Where connections wait, all on one thread, until the head of a request is there.
///
/// Laws: a connection that waits costs no thread and at most `kMaxHeadBytes`, all of them at most
/// `max_head_bytes`, and none waits for ever. Where there are too many or they hold too much, the
/// one that has waited longest goes, those first that have nothing left to ask. So who comes and
/// asks at once gets in, however many sit there. Whose request lies with the kernel already, and
/// has not been looked at yet, stays as long as there are others.
/// Cost: a system call or three for a request. epoll(7).
class Reception {
  public:
    /// Called on the thread of `run`, and must not take long.
    using Receive = std::function<void(Arrival)>;

    /// Takes over the listening socket. The totals outlive it.
    Reception(int listener, ReceptionOptions options, ConnectionTotals& totals, Receive receive);
    ~Reception();
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

    /// Until `stop`: what has arrived by then is handed over. False: the listening socket failed.
    /// What cannot be taken for want of memory is closed.
    bool run();

    /// Closes the listening socket and all connections that wait. From any thread, once or more.
    void stop();

    /// Waits for the next request; after the end of `run` the connection comes back. From any
    /// thread.
    [[nodiscard]] std::unique_ptr<Connection> keep(std::unique_ptr<Connection> connection);

    /// Closes once the client has read the last answer: an end with bytes unread resets the
    /// connection, and the client could lose the answer before it has read it. From any thread.
    void part(std::unique_ptr<Connection> connection);

  private:
    using Time = std::chrono::steady_clock::time_point;

    /// What a connection waits for. In this order they go when there are too many.
    enum class Wait { Parting, Idle, First, Head };
    struct Waiting {
        std::unique_ptr<Connection> connection;
        Wait wait = Wait::First;
        Time since{};
        Time begun{};           ///< of a parting
        std::size_t bytes = 0;  ///< of a head
    };
    /// All that wait for the same, the longest first.
    using Line = std::list<Waiting>;
    using Place = Line::iterator;

    Line& line(Wait wait) { return lines_[static_cast<std::size_t>(wait)]; }
    std::chrono::milliseconds longest(Wait wait) const;

    Place enter(std::unique_ptr<Connection> connection, Wait wait);
    std::unique_ptr<Connection> enter_unless_closed(std::unique_ptr<Connection> connection,
                                                    Wait wait);
    std::unique_ptr<Connection> leave(Place place);
    void move_to(Place place, Wait wait);
    bool send_one_away();
    std::optional<Place> silent_in(Line& line) const;
    void send_away(Place place);

    void accept_all(std::vector<Arrival>& arrived);
    bool accept_one(std::vector<Arrival>& arrived);
    void take_turn(int socket, std::vector<Arrival>& arrived);
    void take_last_turn(std::vector<Arrival>& arrived);
    void hand_over(std::vector<Arrival>& arrived);
    void look_at(Place place, std::vector<Arrival>& arrived);
    void look_at_parting(Place place);
    void look_again(Place place);
    void look_at_bytes(Place place, std::vector<Arrival>& arrived);
    void end_waits(std::vector<Arrival>& arrived);
    void listen(bool wanted);
    void pause(std::chrono::milliseconds longest);
    bool has_pending() const;
    int next_look() const;

    const ReceptionOptions options_;
    const Receive receive_;
    ConnectionTotals& totals_;
    int listener_ = -1;
    int events_ = -1;  ///< the epoll instance
    int waker_ = -1;   ///< an eventfd
    std::atomic<bool> stopping_{false};
    bool listening_ = false;
    bool failed_ = false;
    Time paused_until_{};

    mutable std::mutex mutex_;  ///< guards the next
    std::array<Line, 4> lines_;
    std::unordered_map<int, Place> places_;  ///< by socket
    std::size_t head_bytes_ = 0;             ///< of all in the line of heads
    bool closed_ = false;
};

}  // namespace tinsmith::server
