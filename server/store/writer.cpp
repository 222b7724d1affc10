// SPDX-License-Identifier: Apache-2.0
// The writer's queue and its turns; what a turn commits is in writer_commits.cpp.
#include "server/store/writer.hpp"

#include <algorithm>
#include <utility>

namespace tinsmith::server::store {

namespace {

/// How long what nobody waits for is kept back for the sake of a commit that comes anyway.
constexpr std::chrono::milliseconds kSideWorkWaits{1000};

/// Under a load that never ends, what is idle is dropped each so many turns.
constexpr std::uint64_t kTurnsADrop = 8;

std::future<Committed> ready(std::promise<Committed>& promise, Committed value) {
    promise.set_value(std::move(value));
    return promise.get_future();
}

}  // namespace

Writer::Writer(const JournalOptions& options, Database database, const Inventory& inventory,
               Catalog& catalog, Pulse& pulse)
    : options_(options),
      catalog_(catalog),
      pulse_(pulse),
      rows_(std::make_unique<RowWriter>(std::move(database))),
      next_answer_(inventory.next_answer),
      answer_bytes_(inventory.answer_bytes) {
    for (const Keys& keys : inventory.idle_entries)
        idle_.push_back({Idle::What::Entries, keys, 0});
    for (const Keys& keys : inventory.idle_parts)
        idle_.push_back({Idle::What::Parts, keys, 0});
    sweep_answers();
    thread_ = std::thread([this] { run(); });
}

Writer::~Writer() {
    close();
}

std::future<Committed> Writer::refuse(TaskPtr task) const {
    return ready(task->done,
                 JournalFault{JournalFault::Kind::Closed, "the journal takes no more on"});
}

std::future<Committed> Writer::submit(TaskPtr task) {
    std::unique_lock lock(mutex_);
    const std::size_t bytes = task->bytes();
    room_.wait(lock, [this, bytes] {
        const bool fits =
            queue_.size() < options_.queue_entries && queue_bytes_ + bytes <= options_.queue_bytes;
        // One that is larger than the queue goes alone.
        return state_ != State::Working || queue_.empty() || fits;
    });
    if (state_ != State::Working) return refuse(std::move(task));
    auto done = task->done.get_future();
    queue_.push_back(std::move(task));
    queue_bytes_ += bytes;
    work_.notify_one();
    return done;
}

std::future<Committed> Writer::submit_large(TaskPtr task) {
    const std::lock_guard lock(mutex_);
    if (state_ != State::Working) return refuse(std::move(task));
    auto done = task->done.get_future();
    large_.push_back(std::move(task));
    work_.notify_one();
    return done;
}

void Writer::give_up(Keys parts) {
    add_idle({Idle::What::Parts, parts, 0});
}

void Writer::add_idle(Idle idle) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(idle);
    work_.notify_one();
}

/// Requires: the lock.
void Writer::set_side_work_due() {
    if (side_work_due_) return;
    side_work_due_ = Clock::now() + kSideWorkWaits;
    work_.notify_one();
}

void Writer::touch(const std::string& birth, std::int64_t time) {
    const std::lock_guard lock(mutex_);
    side_work_.touched[birth] = time;
    set_side_work_due();
}

void Writer::keep_answer(KeptAnswerRow answer) {
    std::unique_lock lock(mutex_);
    const std::size_t bytes = SideWork::bytes_of(answer);
    if (state_ != State::Working ||
        side_work_.answer_bytes + bytes > options_.waiting_answer_bytes) {
        lock.unlock();
        pulse_.note_answers_dropped(1);
        return;
    }
    side_work_.add(std::move(answer));
    set_side_work_due();
}

void Writer::forget_answers(std::int64_t older_than) {
    add_idle({Idle::What::OldAnswers, {}, older_than});
}

std::pair<std::size_t, std::size_t> Writer::queued() const {
    const std::lock_guard lock(mutex_);
    return {queue_.size(), queue_bytes_};
}

void Writer::close() {
    {
        const std::lock_guard lock(mutex_);
        if (state_ == State::Closed) return;
        state_ = State::Closing;
    }
    work_.notify_all();
    room_.notify_all();
    if (thread_.joinable()) thread_.join();
    // Where this is the last connection, SQLite moves the log into the file and removes it.
    rows_.reset();
    const std::lock_guard lock(mutex_);
    state_ = State::Closed;
}

void Writer::run() {
    if (options_.grow_log) grow_log();
    std::unique_lock lock(mutex_);
    for (;;) {
        while (!has_work()) {
            if (const auto wake = wake_time()) {
                work_.wait_until(lock, *wake);
            } else {
                work_.wait(lock);
            }
        }
        const bool last_turn = state_ != State::Working && queue_.empty() && large_.empty();
        do_turn(lock);
        if (last_turn) break;
    }
    lock.unlock();
    mark_newest();
}

/// Requires: the lock.
bool Writer::has_work() const {
    if (state_ != State::Working || !queue_.empty() || !large_.empty()) return true;
    // While the disk fails it is asked by probes alone, unless somebody waits.
    if (pulse_.is_failing()) return Clock::now() >= next_probe_;
    return !idle_.empty() || (side_work_due_ && Clock::now() >= *side_work_due_);
}

/// When there may be work without a call. Requires: the lock.
std::optional<Writer::Clock::time_point> Writer::wake_time() const {
    return pulse_.is_failing() ? next_probe_ : side_work_due_;
}

/// Requires: the lock; it is let go while the disk is used.
void Writer::do_turn(std::unique_lock<std::mutex>& lock) {
    ++turns_;
    const bool closing = state_ != State::Working;
    std::vector<TaskPtr> group = take_group();
    SideWork side_work;
    const bool is_due = side_work_due_ && (closing || Clock::now() >= *side_work_due_);
    if (!group.empty() || (is_due && !pulse_.is_failing())) {
        side_work = std::exchange(side_work_, {});
        side_work_due_.reset();
    }
    TaskPtr large;
    if (!large_.empty()) {
        large = std::move(large_.front());
        large_.pop_front();
    }
    const bool has_idle = !idle_.empty();
    lock.unlock();
    room_.notify_all();

    const bool has_waiting = !group.empty() || large;
    if (!group.empty() || !side_work.empty()) commit_group(std::move(group), std::move(side_work));
    checkpoint();
    if (large) {
        commit_large(std::move(large));
        checkpoint();
    }
    if (pulse_.is_failing()) {
        if (Clock::now() >= next_probe_) probe();
    } else if (has_idle && !closing && (!has_waiting || turns_ % kTurnsADrop == 0)) {
        drop_a_piece();
        checkpoint();
    }
    lock.lock();
}

/// Requires: the lock.
std::vector<Writer::TaskPtr> Writer::take_group() {
    std::vector<TaskPtr> group;
    std::size_t bytes = 0;
    while (!queue_.empty() && group.size() < options_.group_entries) {
        const std::size_t more = queue_.front()->bytes();
        if (!group.empty() && bytes + more > options_.group_bytes) break;
        bytes += more;
        queue_bytes_ -= more;
        group.push_back(std::move(queue_.front()));
        queue_.pop_front();
    }
    return group;
}

}  // namespace tinsmith::server::store
