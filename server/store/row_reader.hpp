// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/store/database.hpp"
#include "server/store/layout.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

/// Reads rows and holds each against its checksum. What a function could read is in its last
/// argument, whatever it returns; nothing: it is what was written. Faults are Damaged where the
/// file is to blame, Io where the disk did not answer.
class RowReader {
  public:
    /// Requires: the database outlives it.
    explicit RowReader(const Database& database);

    std::optional<JournalFault> session(std::int64_t number, StoredFacts& out);
    std::optional<JournalFault> snapshot(std::int64_t number, const std::string& birth,
                                         SnapshotRow& out);
    /// Nothing where it is not what was written: the rest of the session does without.
    std::optional<UsedRow> used(std::int64_t number);
    /// Appends it.
    std::optional<JournalFault> part(std::int64_t key, const std::string& birth, std::string& out);
    /// The newest of the session after that version; unchanged where there is none.
    std::optional<JournalFault> newest_entry(std::int64_t number, const std::string& birth,
                                             std::uint64_t after, std::optional<JournalEntry>& out);

    /// Starts on the entries after that version; `next_entry` gives one after the other.
    void start_entries(std::int64_t number, const std::string& birth, std::uint64_t after);
    std::optional<JournalFault> next_entry(std::optional<JournalEntry>& out);

  private:
    std::optional<JournalFault> take_entry(Statement& statement, std::int64_t number,
                                           const std::string& birth,
                                           std::optional<JournalEntry>& out);

    Statement session_;
    Statement snapshot_;
    Statement used_;
    Statement part_;
    Statement newest_;
    Statement entries_;
    std::int64_t number_ = 0;  ///< whose entries
    std::string birth_;
};

/// "entry of version 7 of session ab12": a place in words.
std::string place_of(const std::string& what, const std::string& birth);

}  // namespace tinsmith::server::store
