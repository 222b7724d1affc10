// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "server/store/reading.hpp"
#include "server/store/row_reader.hpp"

namespace tinsmith::server::store {

namespace {

using Step = Statement::Step;

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
/// Past what a damaged table may hide.
constexpr std::int64_t kLeap = 1'000'000;

/// What a walk over keys came to.
struct Walk {
    std::set<std::int64_t> numbers;
    bool whole = true;  ///< and no damaged page hides others
    std::optional<JournalFault> fault;
};

/// Numbers in a column that the key begins with, each once: from key to key at the start of the
/// next number, so that the rows of one number are not walked over. From both ends: of one damaged
/// page nothing is lost but what is on it.
Walk numbers_in(Database& database, const std::string& table, const std::string& key, int bits) {
    Walk walk;
    const std::string from = "SELECT " + key + " FROM " + table + " WHERE " + key;
    Statement up = database.prepare((from + " >= ? ORDER BY " + key + " LIMIT 1").c_str());
    Statement down = database.prepare((from + " < ? ORDER BY " + key + " DESC LIMIT 1").c_str());
    for (std::int64_t next = 0;;) {
        const Step step = up.bind(1, next).step();
        if (step == Step::Done) return walk;
        if (step == Step::Failed) break;
        const std::int64_t number = up.integer(0) >> bits;
        up.reset();
        walk.numbers.insert(number);
        if (number >= kLargest >> bits) return walk;
        next = (number + 1) << bits;
    }
    walk.whole = false;
    if (up.fault().kind != DatabaseFault::Kind::Corrupt) {
        walk.fault = fault_from(up.fault(), "reading table " + table);
        return walk;
    }
    for (std::int64_t next = kLargest;;) {
        if (down.bind(1, next).step() != Step::Row) return walk;
        const std::int64_t number = down.integer(0) >> bits;
        down.reset();
        // Only where keys are out of order can it be there already.
        if (!walk.numbers.insert(number).second) return walk;
        next = number << bits;
    }
}

std::int64_t after_last(const Walk& walk) {
    const std::int64_t last = walk.numbers.empty() ? 0 : *walk.numbers.rbegin();
    return last + 1 + (walk.whole ? 0 : kLeap);
}

/// A fault of the disk; damage is told in the row.
std::optional<JournalFault> list_one(RowReader& reader, Listed& listed) {
    SessionRow& row = listed.row;
    const auto is_read = [&row](const std::optional<JournalFault>& fault) {
        if (fault && row.damage.empty()) row.damage = fault->text;
        return !fault || fault->kind == JournalFault::Kind::Damaged;
    };
    auto fault = reader.session(listed.number, row.session);
    if (!is_read(fault)) return fault;
    SnapshotRow snapshot;
    fault = reader.snapshot(listed.number, row.session.birth, snapshot);
    if (!is_read(fault)) return fault;
    listed.snapshot = snapshot.number;
    row.snapshot_version = row.version = snapshot.head.version;
    row.view = std::move(snapshot.head.view);
    if (!row.damage.empty()) return std::nullopt;
    std::optional<JournalEntry> newest;
    fault = reader.newest_entry(listed.number, row.session.birth, row.version, newest);
    if (!is_read(fault)) return fault;
    if (newest) {
        row.version = newest->version;
        row.view = std::move(newest->view);
    }
    if (const auto used = reader.used(listed.number)) {
        row.session.used = used->time;
        // A damaged head of a page can hide rows from SQLite without a word.
        if (row.damage.empty() && used->newest > row.version)
            row.damage = place_of("versions " + std::to_string(row.version + 1) + " to " +
                                      std::to_string(used->newest),
                                  row.session.birth) +
                         " are missing";
    }
    return std::nullopt;
}

struct Sessions {
    std::vector<Listed> rows;
    bool whole = true;  ///< no session is damaged or hidden by damage
    std::int64_t next = 1;
    std::int64_t next_snapshot = 1;
};

std::variant<Sessions, JournalFault> list_all(Database& database) {
    Sessions sessions;
    // Each of them has a row in both: what one table has lost, the other one knows of.
    Walk walk = numbers_in(database, "session", "number", 0);
    const Walk others = numbers_in(database, "snapshot", "session", 0);
    if (walk.fault) return std::move(*walk.fault);
    if (others.fault) return *others.fault;
    walk.numbers.insert(others.numbers.begin(), others.numbers.end());
    walk.whole = sessions.whole = walk.whole && others.whole;
    sessions.next = after_last(walk);
    RowReader reader(database);
    for (const std::int64_t number : walk.numbers) {
        Listed listed;
        listed.number = number;
        if (auto fault = list_one(reader, listed)) return std::move(*fault);
        sessions.whole = sessions.whole && listed.row.damage.empty();
        sessions.next_snapshot = std::max(sessions.next_snapshot, listed.snapshot + 1);
        sessions.rows.push_back(std::move(listed));
    }
    if (!sessions.whole) sessions.next_snapshot += kLeap;
    return sessions;
}

/// All rows of numbers that are not among those.
std::vector<Keys> without(const Walk& walk, const std::set<std::int64_t>& numbers, int bits) {
    std::vector<Keys> keys;
    for (const std::int64_t number : walk.numbers) {
        if (!numbers.contains(number))
            keys.emplace_back(number << bits, (number << bits) + ((std::int64_t{1} << bits) - 1));
    }
    return keys;
}

std::int64_t ask_or(Database& database, const char* sql, std::int64_t otherwise) {
    const auto answer = database.ask(sql);
    const auto* value = std::get_if<std::int64_t>(&answer);
    return value != nullptr ? *value : otherwise;
}

}  // namespace

std::variant<std::vector<Listed>, JournalFault> list_sessions(Database& database) {
    if (const auto fault = database.run("BEGIN")) return fault_from(*fault, "listing");
    auto all = list_all(database);
    database.run("COMMIT");
    if (auto* fault = std::get_if<JournalFault>(&all)) return std::move(*fault);
    return std::move(std::get<Sessions>(all).rows);
}

std::variant<Inventory, JournalFault> take_inventory(Database& database) {
    auto all = list_all(database);
    if (auto* fault = std::get_if<JournalFault>(&all)) return std::move(*fault);
    auto& sessions = std::get<Sessions>(all);
    const Walk entries = numbers_in(database, "entry", "at", kVersionBits);
    if (entries.fault) return *entries.fault;
    const Walk parts = numbers_in(database, "part", "at", kPartBits);
    if (parts.fault) return *parts.fault;

    Inventory inventory;
    inventory.next_session = std::max(sessions.next, after_last(entries));
    inventory.next_snapshot = std::max(sessions.next_snapshot, after_last(parts));
    inventory.next_answer = ask_or(database, "SELECT max(at) FROM answer", 0) + 1;
    inventory.answer_bytes = static_cast<std::uint64_t>(
        std::max(std::int64_t{0}, ask_or(database, "SELECT sum(length(bytes)) FROM answer", 0)));
    std::set<std::int64_t> numbers;
    std::set<std::int64_t> snapshots;
    for (const Listed& listed : sessions.rows) {
        numbers.insert(listed.number);
        snapshots.insert(listed.snapshot);
        if (listed.row.damage.empty() && entries.numbers.contains(listed.number))
            inventory.idle_entries.emplace_back(
                entry_key(listed.number, 0), entry_key(listed.number, listed.row.snapshot_version));
    }
    // What seems to be nobody's may be a damaged session's.
    if (sessions.whole) {
        inventory.idle_parts = without(parts, snapshots, kPartBits);
        const std::vector<Keys> orphans = without(entries, numbers, kVersionBits);
        inventory.idle_entries.insert(inventory.idle_entries.end(), orphans.begin(), orphans.end());
    }
    inventory.sessions = std::move(sessions.rows);
    return inventory;
}

}  // namespace tinsmith::server::store
