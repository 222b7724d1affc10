// SPDX-License-Identifier: Apache-2.0
// What the writer does for the file's sake: rows that count no more, the log, a disk that fails.
#include <algorithm>
#include <chrono>
#include <limits>

#include "server/log.hpp"
#include "server/store/row_reader.hpp"
#include "server/store/writer.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server::store {

namespace {

constexpr std::int64_t kEntriesAPiece = 500;
constexpr std::int64_t kPartsAPiece = 2;
constexpr std::int64_t kAnswersAPiece = 100;

using Result = RowWriter::Result;

}  // namespace

void Writer::drop_a_piece() {
    Idle idle;
    {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return;
        idle = idle_.front();
    }
    Dropped dropped;
    const Result fault = transact(0, 0, [&] { return drop_rows(idle, dropped); });
    if (fault && !fault->is_of_rows()) return;  // again when the disk is well
    if (fault) {
        log_event(LogLevel::Warning, "journal_failed",
                  "rows that count no more stay, " + told(*fault).text);
    } else {
        pulse_.note_swept(static_cast<std::uint64_t>(dropped.rows));
        answer_bytes_ -= std::min(answer_bytes_, static_cast<std::uint64_t>(dropped.answer_bytes));
        if (dropped.more) return;
    }
    if (idle.what == Idle::What::SurplusAnswers) is_sweeping_answers_ = false;
    const std::lock_guard lock(mutex_);
    idle_.pop_front();
}

Result Writer::drop_rows(const Idle& idle, Dropped& dropped) {
    auto& [rows, freed, more] = dropped;
    Result fault;
    switch (idle.what) {
        case Idle::What::Entries:
            fault = rows_->drop_entries(idle.keys, kEntriesAPiece, rows);
            more = rows == kEntriesAPiece;
            break;
        case Idle::What::Parts:
            fault = rows_->drop_parts(idle.keys, kPartsAPiece, rows);
            more = rows == kPartsAPiece;
            break;
        case Idle::What::OldAnswers:
            fault = rows_->drop_answers(kAnswersAPiece, idle.older_than, rows, freed);
            more = rows == kAnswersAPiece;
            break;
        case Idle::What::SurplusAnswers:
            fault = rows_->drop_answers(kAnswersAPiece, std::numeric_limits<std::int64_t>::max(),
                                        rows, freed);
            more = rows > 0 &&
                   answer_bytes_ > options_.stored_answer_bytes + static_cast<std::uint64_t>(freed);
            break;
    }
    wrote_ = rows > 0;
    return fault;
}

/// With a part of no snapshot, which is dropped at once; the room that it took in the file is the
/// first that is used. Once it is moved, the log begins anew and keeps its length.
void Writer::grow_log() {
    const std::string bytes(static_cast<std::size_t>(std::max(options_.log_pages, 1)) * 4096, 'x');
    const std::int64_t number = catalog_.new_snapshot();
    const Result fault = transact(0, 0, [&] {
        wrote_ = true;
        return rows_->add_part(part_key(number, 0), bytes, 0);
    });
    if (fault) return;
    checkpoint();
    give_up(parts_of(number));
}

/// A small durable write: the disk takes commits again, or it does not.
void Writer::probe() {
    next_probe_ = Clock::now() + options_.probe_every;
    transact(0, 0, [this]() -> Result {
        wrote_ = true;
        return rows_->probe(unix_seconds());
    });
}

/// So that the next one knows how far each session went, also where rows have vanished since.
void Writer::mark_newest() {
    transact(0, 0, [this]() -> Result {
        RowReader reader(rows_->database());
        for (const std::string& birth : unmarked_) {
            const auto known = catalog_.find(birth);
            if (!known || !known->damage.empty()) continue;
            auto used = reader.used(known->number);
            if (!used) continue;
            used->newest = known->newest;
            wrote_ = true;
            if (auto fault = rows_->set_used(known->number, *used)) return fault;
        }
        return std::nullopt;
    });
}

/// Moves the log into the file once it is long: after those who waited for a commit were woken, and
/// not within one.
void Writer::checkpoint() {
    const bool again = pulse_.checkpoint_is_failing() && Clock::now() >= next_probe_;
    if (broken_ || (rows_->pages_to_move() < options_.log_pages && !again)) return;
    const auto start = Clock::now();
    const Result fault = rows_->checkpoint();
    if (!fault) return pulse_.note_checkpoint(Clock::now() - start);
    pulse_.note_checkpoint_failure(told(*fault).text);
    next_probe_ = Clock::now() + options_.probe_every;
    broken_ = fault->kind == DatabaseFault::Kind::Io;
    if (broken_) open_anew();
}

}  // namespace tinsmith::server::store
