// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/store/database.hpp"
#include "server/store/layout.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

/// A session in the store, and where.
struct Listed {
    std::int64_t number = 0;
    std::int64_t snapshot = 0;  ///< its number
    SessionRow row;
};

/// All that a writer has to know of a store.
struct Inventory {
    std::vector<Listed> sessions;  ///< in the order in which they were made
    std::int64_t next_session = 1;
    std::int64_t next_snapshot = 1;
    std::int64_t next_answer = 1;
    std::uint64_t answer_bytes = 0;
    /// Rows that count no more: of entries before a snapshot, of snapshots that were given up or
    /// have a successor, of sessions that were removed. Nothing of which a damaged row might have
    /// told more.
    std::vector<Keys> idle_entries;
    std::vector<Keys> idle_parts;
};

/// The sessions by themselves. A fault is of the disk; damage is in the rows.
std::variant<std::vector<Listed>, JournalFault> list_sessions(Database& database);

/// Cost: a few looks for each session, and one for each answer.
std::variant<Inventory, JournalFault> take_inventory(Database& database);

/// Of a session: where its snapshot is, and the entries since then, up to version `newest`. What
/// stands behind the last of them is not looked at: it may be another's, and damaged.
struct SessionRows {
    StoredFacts facts;
    SnapshotRow snapshot;
    std::vector<JournalEntry> tail;
};
std::variant<SessionRows, JournalFault> read_rows(Database& database, std::int64_t number,
                                                  const std::string& birth, std::uint64_t newest);

/// All of it, as it was at one moment not before this call. `newest`: a version that is there.
/// `most_bytes`: no more can be in the file.
std::variant<StoredSession, JournalFault> read_session(Database& database, std::int64_t number,
                                                       const std::string& birth,
                                                       std::uint64_t newest,
                                                       std::uint64_t most_bytes);

std::variant<std::vector<KeptAnswerRow>, JournalFault> read_answers(Database& database,
                                                                    std::int64_t newer_than);

}  // namespace tinsmith::server::store
