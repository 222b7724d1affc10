// SPDX-License-Identifier: Apache-2.0
// What the writer commits, and what it does where that fails.
#include <algorithm>
#include <new>
#include <string_view>
#include <utility>

#include "server/log.hpp"
#include "server/store/row_reader.hpp"
#include "server/store/writer.hpp"

namespace tinsmith::server::store {

namespace {

using Result = RowWriter::Result;

std::size_t bytes_of(std::span<const std::unique_ptr<Task>> tasks) {
    std::size_t bytes = 0;
    for (const auto& task : tasks)
        bytes += task->bytes();
    return bytes;
}

std::size_t entries_of(std::span<const std::unique_ptr<Task>> tasks) {
    std::size_t entries = 0;
    for (const auto& task : tasks)
        entries += task->entries();
    return entries;
}

JournalFault conflict(const std::string& what, const std::string& birth) {
    return {JournalFault::Kind::Conflict, place_of(what, birth)};
}

}  // namespace

JournalFault Writer::told(const DatabaseFault& fault) const {
    return fault_from(fault, "writing to " + database_file(options_.folder).string());
}

/// A connection that knows nothing of what failed: its buffers may hold what the disk does not, and
/// after a failed sync the system has marked as written what is not, so that a second sync of the
/// same pages says "done". The log goes on after the last commit that was synced, and everything
/// after it is written again. That place is known to the index of the log, which lives as long as
/// one connection does: so the new one is opened before the old one ends. Read from the log itself,
/// the commit that was refused would seem to be one.
bool Writer::open_anew() {
    Database::Opened opened = open_again(options_.folder, Database::Access::Write, options_.vfs);
    auto* database = std::get_if<Database>(&opened);
    if (database == nullptr) return false;
    auto fresh = std::make_unique<RowWriter>(std::move(*database));
    if (fresh->look()) return false;
    rows_ = std::move(fresh);
    broken_ = false;
    return true;
}

Result Writer::transact(std::size_t entries, std::size_t bytes,
                        const std::function<Result()>& work) {
    const auto start = Clock::now();
    wrote_ = false;
    Result fault;
    if (broken_ && !open_anew()) {
        fault = DatabaseFault{DatabaseFault::Kind::Io, "the file cannot be opened again"};
    } else {
        try {
            fault = rows_->begin();
            if (!fault) fault = work();
            if (!fault) fault = rows_->commit();
        } catch (const std::bad_alloc&) {
            fault = DatabaseFault{DatabaseFault::Kind::Io, "out of memory"};
        }
    }
    if (!fault) {
        if (wrote_) pulse_.note_commit(Clock::now() - start, entries, bytes);
        return fault;
    }
    rows_->roll_back();
    if (fault->is_of_rows()) return fault;
    pulse_.note_failure(told(*fault).text);
    next_probe_ = Clock::now() + options_.probe_every;
    if (fault->kind == DatabaseFault::Kind::Io) {
        broken_ = true;
        open_anew();
    }
    return fault;
}

void Writer::commit_group(std::vector<TaskPtr> group, SideWork side_work) {
    Result fault = commit_tasks(group, &side_work);
    if (fault && fault->is_of_rows()) {
        commit_apart(group);
        fault = commit_tasks({}, &side_work);
        // Nobody waits for these, and the table that takes no answers would hold up all commits.
        if (fault && fault->is_of_rows()) {
            log_event(LogLevel::Warning, "journal_failed",
                      "kept answers are lost, " + told(*fault).text);
            side_work = {};
            fault.reset();
        }
    } else if (fault) {
        for (const TaskPtr& task : group) {
            if (!task->refusal) task->refusal = told(*fault);
        }
    }
    for (const TaskPtr& task : group)
        task->done.set_value(std::move(task->refusal));
    if (!fault || side_work.empty()) return;
    const std::lock_guard lock(mutex_);
    side_work_.put_back(std::move(side_work));
    set_side_work_due();
}

/// The tasks of one session in a transaction, those of the next one in another: so that the session
/// whose rows are damaged is the only one that is refused.
void Writer::commit_apart(std::vector<TaskPtr>& group) {
    std::stable_sort(group.begin(), group.end(),
                     [](const TaskPtr& a, const TaskPtr& b) { return a->birth < b->birth; });
    for (auto first = group.begin(); first != group.end();) {
        const std::string& birth = (*first)->birth;
        const auto last = std::find_if(
            first, group.end(), [&birth](const TaskPtr& task) { return task->birth != birth; });
        const std::span<const TaskPtr> tasks(first, last);
        Result fault = commit_tasks(tasks, nullptr);
        if (fault && fault->is_of_rows() && move_session(birth))
            fault = commit_tasks(tasks, nullptr);
        if (fault) {
            JournalFault words = told(*fault);
            if (fault->is_of_rows()) {
                words.kind = JournalFault::Kind::Damaged;
                words.text = place_of("the entries", birth) + ": " + words.text;
                catalog_.set_damage(birth, words.text);
                log_event(LogLevel::Error, "session_damaged", words.text);
            }
            for (const TaskPtr& task : tasks) {
                if (!task->refusal) task->refusal = words;
            }
        }
        first = last;
    }
}

/// To a place of its own behind all others, if each of its rows can be read. An entry that fills a
/// page is laid out anew with the pages beside it, and one of those may be a neighbour's and
/// damaged: that must not stop this session.
bool Writer::move_session(const std::string& birth) {
    const auto known = catalog_.find(birth);
    if (!known) return false;
    const std::int64_t number = catalog_.new_session();
    bool is_whole = false;
    const Result fault = transact(0, 0, [&]() -> Result {
        const auto read = read_rows(rows_->database(), known->number, birth, known->newest);
        const auto* rows = std::get_if<SessionRows>(&read);
        if (rows == nullptr) return std::nullopt;
        is_whole = true;
        wrote_ = true;
        const auto used = RowReader(rows_->database()).used(known->number);
        const std::int64_t time = used ? used->time : rows->facts.used;
        if (auto refused = rows_->set_used(number, {time, known->newest})) return refused;
        if (auto refused = rows_->remove_session(known->number)) return refused;
        if (auto refused = rows_->add_session(number, rows->facts)) return refused;
        if (auto refused = rows_->set_snapshot(number, birth, rows->snapshot)) return refused;
        for (const JournalEntry& entry : rows->tail) {
            if (auto refused = rows_->add_entry(number, entry, sum_of(entry))) return refused;
        }
        return std::nullopt;
    });
    if (fault || !is_whole) return false;
    catalog_.set_number(birth, number);
    add_idle({Idle::What::Entries,
              {entry_key(known->number, 0), entry_key(known->number, kLastVersion)},
              0});
    log_event(LogLevel::Warning, "session_damaged",
              "rows beside those of session " + birth +
                  " are damaged; it was moved away from them, whole");
    return true;
}

void Writer::commit_large(TaskPtr task) {
    const std::span<const TaskPtr> tasks(&task, 1);
    const Result fault = commit_tasks(tasks, nullptr);
    if (fault && !task->refusal) {
        task->refusal = told(*fault);
        if (fault->is_of_rows()) task->refusal->kind = JournalFault::Kind::Damaged;
    }
    task->done.set_value(std::move(task->refusal));
}

Result Writer::commit_tasks(std::span<const TaskPtr> tasks, SideWork* side_work) {
    Result fault =
        transact(entries_of(tasks), bytes_of(tasks), [this, tasks, side_work]() -> Result {
            std::unordered_map<std::string, std::uint64_t> newest;
            for (const TaskPtr& task : tasks) {
                task->refusal.reset();
                if (auto refused = do_task(*task, newest)) return refused;
            }
            return side_work != nullptr ? do_side_work(*side_work) : std::nullopt;
        });
    if (fault) return fault;
    for (const TaskPtr& task : tasks) {
        if (!task->refusal) enter_into_catalog(*task);
    }
    if (side_work != nullptr) count_answers(side_work->answers);
    return std::nullopt;
}

Result Writer::do_task(Task& task, std::unordered_map<std::string, std::uint64_t>& newest) {
    if (const auto* add = std::get_if<AddEntry>(&task.what)) return do_entry(task, *add, newest);
    if (const auto* part = std::get_if<AddPart>(&task.what)) {
        wrote_ = true;
        return rows_->add_part(part->key, part->bytes, part->sum);
    }
    if (const auto* publish = std::get_if<Publish>(&task.what)) return do_publish(task, *publish);
    return do_remove(task);
}

/// `newest`: the versions that this transaction has brought before.
Result Writer::do_entry(Task& task, const AddEntry& add,
                        std::unordered_map<std::string, std::uint64_t>& newest) {
    const auto known = catalog_.find(task.birth);
    if (!known) {
        task.refusal = gone(task.birth);
        return std::nullopt;
    }
    if (!known->damage.empty()) {
        task.refusal = JournalFault{JournalFault::Kind::Damaged, known->damage};
        return std::nullopt;
    }
    std::uint64_t& before = newest.try_emplace(task.birth, known->newest).first->second;
    if (add.entry.version != before + 1 || add.entry.version > kLastVersion) {
        task.refusal = conflict("version " + std::to_string(add.entry.version) +
                                    " cannot follow version " + std::to_string(before),
                                task.birth);
        return std::nullopt;
    }
    wrote_ = true;
    if (auto fault = rows_->add_entry(known->number, add.entry, add.sum)) return fault;
    ++before;
    return std::nullopt;
}

Result Writer::do_publish(Task& task, const Publish& publish) {
    const auto known = catalog_.find(task.birth);
    if (!publish.made) {
        const std::uint64_t version = publish.snapshot.head.version;
        if (!known) {
            task.refusal = gone(task.birth);
        } else if (version < known->snapshot_version || version > known->newest) {
            task.refusal =
                conflict("a snapshot of version " + std::to_string(version) +
                             " is none of those from " + std::to_string(known->snapshot_version) +
                             " to " + std::to_string(known->newest),
                         task.birth);
        }
        if (task.refusal) return std::nullopt;
    }
    wrote_ = true;
    const AddPart& part = publish.last_part;
    if (auto fault = rows_->add_part(part.key, part.bytes, part.sum)) return fault;
    if (publish.made) {
        if (auto fault = rows_->add_session(publish.number, *publish.made)) return fault;
        const UsedRow used{publish.made->used, publish.snapshot.head.version};
        if (auto fault = rows_->set_used(publish.number, used)) return fault;
    }
    const std::int64_t number = publish.made ? publish.number : known->number;
    if (auto fault = rows_->set_snapshot(number, task.birth, publish.snapshot)) return fault;
    return add_answers(publish.answers);
}

/// Requires: a transaction with no other answers.
Result Writer::add_answers(const std::deque<KeptAnswerRow>& answers) {
    std::int64_t key = next_answer_;
    for (const KeptAnswerRow& answer : answers) {
        wrote_ = true;
        if (auto fault = rows_->add_answer(key++, answer)) return fault;
    }
    return std::nullopt;
}

Result Writer::do_remove(Task& task) {
    const auto known = catalog_.find(task.birth);
    if (!known) {
        task.refusal = gone(task.birth);
        return std::nullopt;
    }
    wrote_ = true;
    return rows_->remove_session(known->number);
}

Result Writer::do_side_work(const SideWork& side_work) {
    for (const auto& [birth, time] : side_work.touched) {
        const auto known = catalog_.find(birth);
        if (!known) continue;
        wrote_ = true;
        if (auto fault = rows_->set_used(known->number, {time, known->newest})) return fault;
    }
    return add_answers(side_work.answers);
}

/// Those that are stored now.
void Writer::count_answers(const std::deque<KeptAnswerRow>& answers) {
    next_answer_ += static_cast<std::int64_t>(answers.size());
    for (const KeptAnswerRow& answer : answers)
        answer_bytes_ += answer.bytes.size();
    sweep_answers();
}

/// Has those beyond the bound dropped, the oldest first, unless that is on its way.
void Writer::sweep_answers() {
    if (answer_bytes_ <= options_.stored_answer_bytes || is_sweeping_answers_) return;
    is_sweeping_answers_ = true;
    add_idle({Idle::What::SurplusAnswers, {}, 0});
}

/// What was committed, and what counts no more since.
void Writer::enter_into_catalog(const Task& task) {
    if (const auto* add = std::get_if<AddEntry>(&task.what)) {
        catalog_.set_newest(task.birth, add->entry.version);
        unmarked_.insert(task.birth);
        return;
    }
    if (std::holds_alternative<AddPart>(task.what)) return;
    if (const auto* publish = std::get_if<Publish>(&task.what)) {
        const SnapshotRow& snapshot = publish->snapshot;
        const std::uint64_t version = snapshot.head.version;
        count_answers(publish->answers);
        if (publish->made) {
            catalog_.add(*publish->made, {publish->number, publish->made->id, version, version,
                                          snapshot.number, std::string()});
            return;
        }
        const auto known = catalog_.find(task.birth);
        catalog_.set_snapshot(task.birth, snapshot.number, version);
        if (!known) return;
        add_idle({Idle::What::Entries,
                  {entry_key(known->number, 0), entry_key(known->number, version)},
                  0});
        add_idle({Idle::What::Parts, parts_of(known->snapshot), 0});
        return;
    }
    const auto known = catalog_.find(task.birth);
    catalog_.remove(task.birth);
    if (!known) return;
    add_idle({Idle::What::Entries,
              {entry_key(known->number, 0), entry_key(known->number, kLastVersion)},
              0});
    add_idle({Idle::What::Parts, parts_of(known->snapshot), 0});
}

}  // namespace tinsmith::server::store
