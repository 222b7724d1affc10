// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/store/catalog.hpp"
#include "server/store/journal.hpp"
#include "server/store/pulse.hpp"
#include "server/store/row_writer.hpp"
#include "server/store/side_work.hpp"
#include "server/store/task.hpp"

namespace tinsmith::server::store {

/// The one thread that writes. Each turn it takes all entries that wait, commits them with one sync
/// and wakes those who wait for them; then one large thing, a part of a snapshot; then, where there
/// is leisure, a piece of what counts no more is dropped. So an entry waits for the turn that runs
/// and for its own: of everything else no more than one part goes before it.
///
/// Laws: a promise is kept after the commit and the catalog's change, or with the reason why there
/// was none. Tasks of one lane are done in the order in which they came.
class Writer {
  public:
    Writer(const JournalOptions& options, Database database, const Inventory& inventory,
           Catalog& catalog, Pulse& pulse);
    /// Does what waits, then ends.
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// Waits for room.
    std::future<Committed> submit(std::unique_ptr<Task> task);
    /// For what is large: `submit` does not wait for these. The caller keeps a few of them under
    /// way at most.
    std::future<Committed> submit_large(std::unique_ptr<Task> task);
    /// Parts that nobody has published and nobody will.
    void give_up(Keys parts);

    void touch(const std::string& birth, std::int64_t time);
    void keep_answer(KeptAnswerRow answer);
    void forget_answers(std::int64_t older_than);

    /// Entries and bytes that wait.
    std::pair<std::size_t, std::size_t> queued() const;

    /// Takes no more on, does what waits, ends the thread and closes the file.
    void close();

  private:
    using TaskPtr = std::unique_ptr<Task>;
    using Clock = std::chrono::steady_clock;
    /// Rows to be dropped, some at a time.
    struct Idle {
        enum class What { Entries, Parts, OldAnswers, SurplusAnswers };
        What what = What::Entries;
        Keys keys;                    ///< of entries and parts
        std::int64_t older_than = 0;  ///< answers
    };
    enum class State { Working, Closing, Closed };

    void run();
    bool has_work() const;
    std::optional<Clock::time_point> wake_time() const;
    void do_turn(std::unique_lock<std::mutex>& lock);
    std::vector<TaskPtr> take_group();
    std::future<Committed> refuse(TaskPtr task) const;
    void set_side_work_due();
    void add_idle(Idle idle);

    void commit_group(std::vector<TaskPtr> group, SideWork side_work);
    void commit_apart(std::vector<TaskPtr>& group);
    bool move_session(const std::string& birth);
    void commit_large(TaskPtr task);
    void drop_a_piece();
    struct Dropped {
        std::int64_t rows = 0;
        std::int64_t answer_bytes = 0;
        bool more = false;
    };
    RowWriter::Result drop_rows(const Idle& idle, Dropped& dropped);
    void grow_log();
    void probe();
    void mark_newest();
    void checkpoint();

    /// One transaction around the work. Rolled back, and told, where it fails.
    RowWriter::Result transact(std::size_t entries, std::size_t bytes,
                               const std::function<RowWriter::Result()>& work);
    RowWriter::Result commit_tasks(std::span<const TaskPtr> tasks, SideWork* side_work);
    RowWriter::Result do_task(Task& task, std::unordered_map<std::string, std::uint64_t>& newest);
    RowWriter::Result do_entry(Task& task, const AddEntry& add,
                               std::unordered_map<std::string, std::uint64_t>& newest);
    RowWriter::Result do_publish(Task& task, const Publish& publish);
    RowWriter::Result do_remove(Task& task);
    RowWriter::Result do_side_work(const SideWork& side_work);
    RowWriter::Result add_answers(const std::deque<KeptAnswerRow>& answers);
    void count_answers(const std::deque<KeptAnswerRow>& answers);
    void sweep_answers();
    void enter_into_catalog(const Task& task);
    bool open_anew();
    JournalFault told(const DatabaseFault& fault) const;

    const JournalOptions options_;
    Catalog& catalog_;
    Pulse& pulse_;

    mutable std::mutex mutex_;
    std::condition_variable work_;
    std::condition_variable room_;
    std::deque<TaskPtr> queue_;
    std::deque<TaskPtr> large_;
    std::size_t queue_bytes_ = 0;
    SideWork side_work_;
    std::optional<Clock::time_point> side_work_due_;
    std::deque<Idle> idle_;
    State state_ = State::Working;

    // Of the thread alone.
    std::unique_ptr<RowWriter> rows_;
    bool broken_ = false;             ///< the connection has met an I/O error
    bool wrote_ = false;              ///< something, in the transaction under way
    std::set<std::string> unmarked_;  ///< births that have versions which `used` does not know of
    std::int64_t next_answer_;
    std::uint64_t answer_bytes_;
    bool is_sweeping_answers_ = false;
    Clock::time_point next_probe_;
    std::uint64_t turns_ = 0;

    std::thread thread_;  // the last member: it sees the others whole
};

}  // namespace tinsmith::server::store
