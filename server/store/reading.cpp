// SPDX-License-Identifier: Apache-2.0
#include "server/store/reading.hpp"

#include <utility>

#include "server/store/row_reader.hpp"

namespace tinsmith::server::store {

namespace {

JournalFault damaged(const std::string& place, const std::string& why) {
    return {JournalFault::Kind::Damaged, place + ": " + why};
}

}  // namespace

std::variant<SessionRows, JournalFault> read_rows(Database& database, std::int64_t number,
                                                  const std::string& birth, std::uint64_t newest) {
    RowReader reader(database);
    SessionRows rows;
    if (auto fault = reader.session(number, rows.facts)) return std::move(*fault);
    if (rows.facts.birth != birth)
        return damaged(place_of("the row", birth), "it is that of another session");
    if (auto fault = reader.snapshot(number, birth, rows.snapshot)) return std::move(*fault);
    std::uint64_t version = rows.snapshot.head.version;
    reader.start_entries(number, birth, version);
    while (version < newest) {
        std::optional<JournalEntry> entry;
        if (auto fault = reader.next_entry(entry)) return std::move(*fault);
        ++version;
        if (!entry || entry->version != version)
            return damaged(place_of("the entries", birth),
                           "version " + std::to_string(version) + " is missing");
        rows.tail.push_back(std::move(*entry));
    }
    return rows;
}

std::variant<StoredSession, JournalFault> read_session(Database& database, std::int64_t number,
                                                       const std::string& birth,
                                                       std::uint64_t newest,
                                                       std::uint64_t most_bytes) {
    // One look at all of it: a new snapshot may be written meanwhile, and the old one swept.
    if (const auto fault = database.run("BEGIN")) return fault_from(*fault, "reading");
    auto read = read_rows(database, number, birth, newest);
    if (auto* fault = std::get_if<JournalFault>(&read)) return std::move(*fault);
    auto& rows = std::get<SessionRows>(read);

    StoredSession stored;
    stored.tail = std::move(rows.tail);
    stored.head = std::move(rows.snapshot.head);
    if (stored.head.bytes > most_bytes)
        return damaged(place_of("the snapshot", birth), "it is larger than the file");
    stored.bytes.reserve(stored.head.bytes);
    RowReader reader(database);
    for (std::int64_t i = 0; i < rows.snapshot.parts; ++i) {
        const std::int64_t key = part_key(rows.snapshot.number, static_cast<std::uint64_t>(i));
        if (auto fault = reader.part(key, birth, stored.bytes)) return std::move(*fault);
    }
    if (stored.bytes.size() != stored.head.bytes)
        return damaged(place_of("the snapshot", birth),
                       std::to_string(stored.bytes.size()) + " bytes where " +
                           std::to_string(stored.head.bytes) + " were written");
    return stored;
}

std::variant<std::vector<KeptAnswerRow>, JournalFault> read_answers(Database& database,
                                                                    std::int64_t newer_than) {
    Statement rows = database.prepare(
        "SELECT scope, key, print, time, sum, bytes FROM answer WHERE time > ? ORDER BY at");
    rows.bind(1, newer_than);
    std::vector<KeptAnswerRow> answers;
    for (;;) {
        const Statement::Step step = rows.step();
        if (step == Statement::Step::Done) return answers;
        if (step == Statement::Step::Failed) {
            // What follows a damaged page is out of reach: those before it are worth having.
            if (rows.fault().kind == DatabaseFault::Kind::Corrupt) return answers;
            return fault_from(rows.fault(), "reading kept answers");
        }
        KeptAnswerRow answer;
        answer.scope = rows.bytes(0);
        answer.key = rows.bytes(1);
        answer.print = rows.bytes(2);
        answer.time = rows.integer(3);
        answer.bytes = rows.bytes(5);
        if (rows.integer(4) == sum_of(answer)) answers.push_back(std::move(answer));
    }
}

}  // namespace tinsmith::server::store
