// SPDX-License-Identifier: Apache-2.0
#include "server/store/row_writer.hpp"

#include <utility>

namespace tinsmith::server::store {

namespace {

std::int64_t signed_of(std::uint64_t value) {
    return static_cast<std::int64_t>(value);
}

}  // namespace

RowWriter::RowWriter(Database database)
    : database_(std::move(database)),
      look_(database_.prepare("SELECT count(*) FROM probe")),
      // IMMEDIATE: a lock that another program holds is waited for here and not in the middle.
      begin_(database_.prepare("BEGIN IMMEDIATE")),
      commit_(database_.prepare("COMMIT")),
      roll_back_(database_.prepare("ROLLBACK")),
      entry_(database_.prepare("INSERT INTO entry(at, algorithm, sum, view, digest, key, print, "
                               "body) VALUES(?, ?, ?, ?, ?, ?, ?, ?)")),
      part_(database_.prepare("INSERT INTO part(at, bytes, sum) VALUES(?, ?, ?)")),
      session_(database_.prepare("INSERT INTO session(number, birth, id, facts, key, print, made, "
                                 "sum) VALUES(?, ?, ?, ?, ?, ?, ?, ?)")),
      snapshot_(database_.prepare(
          "INSERT OR REPLACE INTO snapshot(session, number, parts, version, algorithm, format, "
          "bytes, digest, view, sum) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")),
      used_(database_.prepare(
          "INSERT OR REPLACE INTO used(number, time, newest, sum) VALUES(?, ?, ?, ?)")),
      answer_(database_.prepare("INSERT INTO answer(at, scope, key, print, time, sum, bytes) "
                                "VALUES(?, ?, ?, ?, ?, ?, ?)")),
      probe_(database_.prepare("INSERT OR REPLACE INTO probe(at, time) VALUES(1, ?)")),
      remove_session_(database_.prepare("DELETE FROM session WHERE number = ?")),
      remove_snapshot_(database_.prepare("DELETE FROM snapshot WHERE session = ?")),
      remove_used_(database_.prepare("DELETE FROM used WHERE number = ?")),
      drop_entries_(database_.prepare(
          "DELETE FROM entry WHERE at IN (SELECT at FROM entry WHERE at BETWEEN ? AND ? "
          "ORDER BY at LIMIT ?) RETURNING 1")),
      drop_parts_(database_.prepare(
          "DELETE FROM part WHERE at IN (SELECT at FROM part WHERE at BETWEEN ? AND ? "
          "ORDER BY at LIMIT ?) RETURNING 1")),
      drop_answers_(database_.prepare(
          "DELETE FROM answer WHERE time < ? AND at IN (SELECT at FROM answer ORDER BY at LIMIT ?) "
          "RETURNING length(bytes)")) {}

void RowWriter::roll_back() {
    if (database_.in_transaction()) roll_back_.run();
}

RowWriter::Result RowWriter::add_entry(std::int64_t number, const JournalEntry& entry,
                                       std::int64_t sum) {
    return entry_.bind(1, entry_key(number, entry.version))
        .bind(2, std::int64_t{entry.algorithm})
        .bind(3, sum)
        .bind(4, entry.view)
        .bind(5, entry.digest)
        .bind(6, entry.key)
        .bind(7, entry.print)
        .bind(8, entry.body)
        .run();
}

RowWriter::Result RowWriter::add_part(std::int64_t key, std::string_view bytes, std::int64_t sum) {
    return part_.bind(1, key).bind(2, bytes).bind(3, sum).run();
}

RowWriter::Result RowWriter::add_session(std::int64_t number, const StoredFacts& session) {
    return session_.bind(1, number)
        .bind(2, session.birth)
        .bind(3, session.id)
        .bind(4, session.facts)
        .bind(5, session.key)
        .bind(6, session.print)
        .bind(7, session.used)
        .bind(8, sum_of(number, session))
        .run();
}

RowWriter::Result RowWriter::set_snapshot(std::int64_t number, std::string_view birth,
                                          const SnapshotRow& snapshot) {
    const SnapshotHead& head = snapshot.head;
    return snapshot_.bind(1, number)
        .bind(2, snapshot.number)
        .bind(3, snapshot.parts)
        .bind(4, signed_of(head.version))
        .bind(5, std::int64_t{head.algorithm})
        .bind(6, std::int64_t{head.format})
        .bind(7, signed_of(head.bytes))
        .bind(8, head.digest)
        .bind(9, head.view)
        .bind(10, sum_of(number, birth, snapshot))
        .run();
}

RowWriter::Result RowWriter::set_used(std::int64_t number, const UsedRow& used) {
    return used_.bind(1, number)
        .bind(2, used.time)
        .bind(3, signed_of(used.newest))
        .bind(4, sum_of(number, used))
        .run();
}

RowWriter::Result RowWriter::remove_session(std::int64_t number) {
    for (Statement* statement : {&remove_session_, &remove_snapshot_, &remove_used_}) {
        if (auto fault = statement->bind(1, number).run()) return fault;
    }
    return std::nullopt;
}

RowWriter::Result RowWriter::add_answer(std::int64_t key, const KeptAnswerRow& answer) {
    return answer_.bind(1, key)
        .bind(2, answer.scope)
        .bind(3, answer.key)
        .bind(4, answer.print)
        .bind(5, answer.time)
        .bind(6, sum_of(answer))
        .bind(7, answer.bytes)
        .run();
}

RowWriter::Result RowWriter::probe(std::int64_t time) {
    return probe_.bind(1, time).run();
}

namespace {

/// Steps to the end and counts the rows that come back, and what is in them.
RowWriter::Result count_rows(Statement& statement, std::int64_t& rows, std::int64_t& sum) {
    rows = 0;
    sum = 0;
    for (;;) {
        switch (statement.step()) {
            case Statement::Step::Row:
                ++rows;
                sum += statement.integer(0);
                break;
            case Statement::Step::Done:
                return std::nullopt;
            case Statement::Step::Failed:
                return statement.fault();
        }
    }
}

}  // namespace

RowWriter::Result RowWriter::drop_entries(Keys keys, std::int64_t most, std::int64_t& done) {
    std::int64_t sum = 0;
    return count_rows(drop_entries_.bind(1, keys.first).bind(2, keys.second).bind(3, most), done,
                      sum);
}

RowWriter::Result RowWriter::drop_parts(Keys keys, std::int64_t most, std::int64_t& done) {
    std::int64_t sum = 0;
    return count_rows(drop_parts_.bind(1, keys.first).bind(2, keys.second).bind(3, most), done,
                      sum);
}

RowWriter::Result RowWriter::drop_answers(std::int64_t most, std::int64_t older_than,
                                          std::int64_t& done, std::int64_t& freed) {
    return count_rows(drop_answers_.bind(1, older_than).bind(2, most), done, freed);
}

}  // namespace tinsmith::server::store
