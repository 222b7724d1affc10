// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "server/store/database.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

// The tables, their keys and their checksums: README.md has the picture.
//
// Every table has one integer for its key and no index beside it, so that there is nothing that
// could say otherwise than the rows, and rows of one session lie next to each other: a damaged page
// is the matter of few.

inline constexpr int kVersionBits = 36;
inline constexpr std::uint64_t kLastVersion = (std::uint64_t{1} << kVersionBits) - 1;
inline constexpr int kPartBits = 20;
inline constexpr std::uint64_t kMostParts = std::uint64_t{1} << kPartBits;
/// SQLite takes a billion bytes for a row.
inline constexpr std::size_t kLargestRow = 900'000'000;

/// The key of the entry that makes that version of session `number`.
constexpr std::int64_t entry_key(std::int64_t number, std::uint64_t version) {
    return static_cast<std::int64_t>((static_cast<std::uint64_t>(number) << kVersionBits) |
                                     version);
}
/// The key of a part of snapshot `number`; parts count from 0.
constexpr std::int64_t part_key(std::int64_t number, std::uint64_t part) {
    return static_cast<std::int64_t>((static_cast<std::uint64_t>(number) << kPartBits) | part);
}

/// The keys from first to second, both among them.
using Keys = std::pair<std::int64_t, std::int64_t>;

/// Of all parts of snapshot `number`.
constexpr Keys parts_of(std::int64_t number) {
    return {part_key(number, 0), part_key(number, kMostParts - 1)};
}

/// A row of `snapshot`: which one is the session's, and in how many parts.
struct SnapshotRow {
    std::int64_t number = 0;
    std::int64_t parts = 0;
    SnapshotHead head;
};

/// A row of `used`: written now and then, and when the journal is closed.
struct UsedRow {
    std::int64_t time = 0;     ///< Unix seconds
    std::uint64_t newest = 0;  ///< a version that was there
};

/// Eight bytes of the SHA-256 over all that a row holds and where it belongs, so that neither a
/// flipped bit nor a row in another's place goes unseen.
std::int64_t sum_of(const JournalEntry& entry);
std::int64_t sum_of_part(std::string_view birth, std::int64_t key, std::string_view bytes);
std::int64_t sum_of(std::int64_t number, const StoredFacts& session);
std::int64_t sum_of(std::int64_t number, std::string_view birth, const SnapshotRow& snapshot);
std::int64_t sum_of(std::int64_t number, const UsedRow& used);
std::int64_t sum_of(const KeptAnswerRow& answer);

std::filesystem::path database_file(const std::filesystem::path& folder);
std::filesystem::path log_file(const std::filesystem::path& folder);

/// A connection to a store, whose format has been checked; Write makes a new one of what is empty.
/// The text says why not and what to do.
std::variant<Database, std::string> open_database(const std::filesystem::path& folder,
                                                  Database::Access access, const std::string& vfs);

/// The same for a store that was checked before.
Database::Opened open_again(const std::filesystem::path& folder, Database::Access access,
                            const std::string& vfs);

JournalFault fault_from(const DatabaseFault& fault, const std::string& doing);

}  // namespace tinsmith::server::store
