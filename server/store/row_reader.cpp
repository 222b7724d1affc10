// SPDX-License-Identifier: Apache-2.0
#include "server/store/row_reader.hpp"

#include <utility>

#include "server/log.hpp"

namespace tinsmith::server::store {

namespace {

using Step = Statement::Step;

constexpr const char* kEntryColumns =
    "SELECT at, algorithm, sum, view, digest, key, print, body FROM entry WHERE at BETWEEN ? AND ?";

std::uint64_t unsigned_of(std::int64_t value) {
    return static_cast<std::uint64_t>(value);
}

JournalFault not_as_written(const std::string& place) {
    return {JournalFault::Kind::Damaged, place + " is not what was written: its checksum differs"};
}

JournalFault missing(const std::string& place) {
    return {JournalFault::Kind::Damaged, place + " is missing"};
}

std::string entry_place(std::uint64_t version, const std::string& birth) {
    return place_of("entry of version " + std::to_string(version), birth);
}

}  // namespace

std::string place_of(const std::string& what, const std::string& birth) {
    return what + " of session " + sanitized(birth);
}

RowReader::RowReader(const Database& database)
    : session_(database.prepare(
          "SELECT birth, id, facts, key, print, made, sum FROM session WHERE number = ?")),
      snapshot_(database.prepare("SELECT number, parts, version, algorithm, format, bytes, digest, "
                                 "view, sum FROM snapshot WHERE session = ?")),
      used_(database.prepare("SELECT time, newest, sum FROM used WHERE number = ?")),
      part_(database.prepare("SELECT bytes, sum FROM part WHERE at = ?")),
      newest_(database.prepare((std::string(kEntryColumns) + " ORDER BY at DESC LIMIT 1").c_str())),
      entries_(database.prepare((std::string(kEntryColumns) + " ORDER BY at").c_str())) {}

std::optional<JournalFault> RowReader::session(std::int64_t number, StoredFacts& out) {
    const std::string place = "row " + std::to_string(number) + " of table session";
    const Step step = session_.bind(1, number).step();
    if (step == Step::Failed) return fault_from(session_.fault(), place);
    if (step == Step::Done) return missing(place);
    out.birth = session_.bytes(0);
    out.id = session_.bytes(1);
    out.facts = session_.bytes(2);
    out.key = session_.bytes(3);
    out.print = session_.bytes(4);
    out.used = session_.integer(5);
    const bool whole = session_.integer(6) == sum_of(number, out);
    session_.reset();
    if (!whole) return not_as_written(place);
    return std::nullopt;
}

std::optional<JournalFault> RowReader::snapshot(std::int64_t number, const std::string& birth,
                                                SnapshotRow& out) {
    const std::string place = place_of("snapshot", birth);
    const Step step = snapshot_.bind(1, number).step();
    if (step == Step::Failed) return fault_from(snapshot_.fault(), place);
    if (step == Step::Done) return missing(place);
    out.number = snapshot_.integer(0);
    out.parts = snapshot_.integer(1);
    out.head.version = unsigned_of(snapshot_.integer(2));
    out.head.algorithm = static_cast<std::uint32_t>(snapshot_.integer(3));
    out.head.format = static_cast<std::uint32_t>(snapshot_.integer(4));
    out.head.bytes = unsigned_of(snapshot_.integer(5));
    out.head.digest = snapshot_.bytes(6);
    out.head.view = snapshot_.bytes(7);
    const bool whole = snapshot_.integer(8) == sum_of(number, birth, out);
    snapshot_.reset();
    if (!whole) return not_as_written(place);
    return std::nullopt;
}

std::optional<UsedRow> RowReader::used(std::int64_t number) {
    if (used_.bind(1, number).step() != Step::Row) return std::nullopt;
    const UsedRow row{used_.integer(0), unsigned_of(used_.integer(1))};
    const bool whole = used_.integer(2) == sum_of(number, row);
    used_.reset();
    return whole ? std::optional(row) : std::nullopt;
}

std::optional<JournalFault> RowReader::part(std::int64_t key, const std::string& birth,
                                            std::string& out) {
    const std::uint64_t part = unsigned_of(key) % kMostParts;
    const std::string place = place_of("part " + std::to_string(part) + " of the snapshot", birth);
    const Step step = part_.bind(1, key).step();
    if (step == Step::Failed) return fault_from(part_.fault(), place);
    if (step == Step::Done) return missing(place);
    const std::string bytes = part_.bytes(0);
    const bool whole = part_.integer(1) == sum_of_part(birth, key, bytes);
    part_.reset();
    if (!whole) return not_as_written(place);
    out += bytes;
    return std::nullopt;
}

std::optional<JournalFault> RowReader::newest_entry(std::int64_t number, const std::string& birth,
                                                    std::uint64_t after,
                                                    std::optional<JournalEntry>& out) {
    newest_.bind(1, entry_key(number, after + 1)).bind(2, entry_key(number, kLastVersion));
    auto fault = take_entry(newest_, number, birth, out);
    newest_.reset();
    return fault;
}

void RowReader::start_entries(std::int64_t number, const std::string& birth, std::uint64_t after) {
    number_ = number;
    birth_ = birth;
    entries_.reset();
    entries_.bind(1, entry_key(number, after + 1)).bind(2, entry_key(number, kLastVersion));
}

std::optional<JournalFault> RowReader::next_entry(std::optional<JournalEntry>& out) {
    out.reset();
    return take_entry(entries_, number_, birth_, out);
}

std::optional<JournalFault> RowReader::take_entry(Statement& statement, std::int64_t number,
                                                  const std::string& birth,
                                                  std::optional<JournalEntry>& out) {
    const Step step = statement.step();
    if (step == Step::Failed) return fault_from(statement.fault(), place_of("the entries", birth));
    if (step == Step::Done) return std::nullopt;
    JournalEntry& entry = out.emplace();
    entry.birth = birth;
    entry.version = unsigned_of(statement.integer(0) - entry_key(number, 0));
    entry.algorithm = static_cast<std::uint32_t>(statement.integer(1));
    entry.view = statement.bytes(3);
    entry.digest = statement.bytes(4);
    entry.key = statement.bytes(5);
    entry.print = statement.bytes(6);
    entry.body = statement.bytes(7);
    if (statement.integer(2) != sum_of(entry)) {
        return not_as_written(entry_place(entry.version, birth));
    }
    return std::nullopt;
}

}  // namespace tinsmith::server::store
