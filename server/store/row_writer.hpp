// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "server/store/database.hpp"
#include "server/store/layout.hpp"
#include "server/store/reading.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

/// The one connection that writes, with its statements. Whoever uses it begins and commits.
class RowWriter {
  public:
    using Result = std::optional<DatabaseFault>;

    explicit RowWriter(Database database);

    /// Reads something.
    Result look() { return look_.run(); }
    Result begin() { return begin_.run(); }
    Result commit() { return commit_.run(); }
    /// Also after a fault that has ended the transaction by itself.
    void roll_back();

    Result add_entry(std::int64_t number, const JournalEntry& entry, std::int64_t sum);
    Result add_part(std::int64_t key, std::string_view bytes, std::int64_t sum);
    Result add_session(std::int64_t number, const StoredFacts& session);
    Result set_snapshot(std::int64_t number, std::string_view birth, const SnapshotRow& snapshot);
    Result set_used(std::int64_t number, const UsedRow& used);
    Result remove_session(std::int64_t number);
    Result add_answer(std::int64_t key, const KeptAnswerRow& answer);
    /// Writes that it was here: whether the disk takes anything.
    Result probe(std::int64_t time);

    /// Drops the first of those rows, so many at most; `done` says how many there were.
    Result drop_entries(Keys keys, std::int64_t most, std::int64_t& done);
    Result drop_parts(Keys keys, std::int64_t most, std::int64_t& done);
    /// Of answers: the oldest so many, if they are older than that; `freed` counts their bytes.
    Result drop_answers(std::int64_t most, std::int64_t older_than, std::int64_t& done,
                        std::int64_t& freed);

    /// To read what this connection sees.
    Database& database() { return database_; }
    int pages_to_move() { return database_.pages_to_move(); }
    Result checkpoint() { return database_.checkpoint(); }

  private:
    Database database_;  // before its statements, which end before it
    Statement look_, begin_, commit_, roll_back_, entry_, part_, session_, snapshot_, used_,
        answer_, probe_, remove_session_, remove_snapshot_, remove_used_, drop_entries_,
        drop_parts_, drop_answers_;
};

}  // namespace tinsmith::server::store
