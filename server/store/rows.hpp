// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tinsmith::server {

/// Why the journal did not do as it was told.
struct JournalFault {
    enum class Kind {
        DiskFull,  ///< no room; the next one may go through
        Io,        ///< the disk, or the system, refused
        Damaged,   ///< what is stored of this session is not what was written
        Closed,    ///< the journal is closing or closed
        Conflict,  ///< the id is taken, the version not the next one, or too much for a row
        Gone,      ///< no session of that birth: removed, or never made
    };
    Kind kind = Kind::Io;
    std::string text;  ///< a sentence for an operator: what, where
};

/// Nothing: done and durable.
using Committed = std::optional<JournalFault>;

/// One change of a session. To the journal all members but the first two are bytes.
struct JournalEntry {
    std::string birth;          ///< of the session
    std::uint64_t version = 0;  ///< that the change makes: one more than the newest before it
    std::uint32_t algorithm = 0;
    std::string body;
    std::string digest;
    std::string key;    ///< the Idempotency-Key; empty: none
    std::string print;  ///< of the request that had it
    std::string view;   ///< what listings tell at that version

    friend bool operator==(const JournalEntry&, const JournalEntry&) = default;
};

/// What a snapshot says of itself; its bytes go beside it.
struct SnapshotHead {
    std::uint64_t version = 0;  ///< below 2^36
    std::uint32_t algorithm = 0;
    std::uint32_t format = 0;
    std::string digest;
    std::string view;         ///< what listings tell at that version
    std::uint64_t bytes = 0;  ///< told by `read`; what is given in is not looked at

    friend bool operator==(const SnapshotHead&, const SnapshotHead&) = default;
};

/// What is fixed when a session is made.
struct StoredFacts {
    std::string birth;  ///< random and unique; not empty
    std::string id;
    std::string facts;      ///< bytes
    std::string key;        ///< the Idempotency-Key that it was made with; empty: none
    std::string print;      ///< of that request
    std::int64_t used = 0;  ///< Unix seconds; `touch` moves it

    friend bool operator==(const StoredFacts&, const StoredFacts&) = default;
};

/// A session as listings see it.
struct SessionRow {
    StoredFacts session;
    std::uint64_t version = 0;           ///< the newest
    std::string view;                    ///< at that version
    std::uint64_t snapshot_version = 0;  ///< where `read` starts
    /// Not empty: what is damaged and where. Then the other members are what could be read, perhaps
    /// nothing; the session takes no more changes, and `remove` by its birth, if there is one,
    /// still works.
    std::string damage;
};

/// An answer to a request that had an Idempotency-Key.
struct KeptAnswerRow {
    std::string scope;  ///< a session's birth, or empty for what belongs to none
    std::string key;
    std::string print;
    std::int64_t time = 0;  ///< Unix seconds
    std::string bytes;

    friend bool operator==(const KeptAnswerRow&, const KeptAnswerRow&) = default;
};

/// All that makes a session again.
struct StoredSession {
    SnapshotHead head;
    std::string bytes;               ///< of the snapshot
    std::vector<JournalEntry> tail;  ///< one for each version after it, in order
};

}  // namespace tinsmith::server
