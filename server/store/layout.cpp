// SPDX-License-Identifier: Apache-2.0
#include "server/store/layout.hpp"

#include <array>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "server/digest.hpp"

namespace tinsmith::server::store {

namespace {

/// "TNSM"; `file` and others find it at byte 68.
constexpr std::int64_t kApplication = 0x544e534d;
constexpr std::int64_t kFormat = 1;

constexpr const char* kTables = R"sql(
    BEGIN IMMEDIATE;
    CREATE TABLE session(number INTEGER PRIMARY KEY, birth BLOB NOT NULL, id BLOB NOT NULL,
        facts BLOB NOT NULL, key BLOB NOT NULL, print BLOB NOT NULL, made INTEGER NOT NULL,
        sum INTEGER NOT NULL) STRICT;
    CREATE TABLE used(number INTEGER PRIMARY KEY, time INTEGER NOT NULL,
        newest INTEGER NOT NULL, sum INTEGER NOT NULL) STRICT;
    CREATE TABLE snapshot(session INTEGER PRIMARY KEY, number INTEGER NOT NULL,
        parts INTEGER NOT NULL, version INTEGER NOT NULL, algorithm INTEGER NOT NULL,
        format INTEGER NOT NULL, bytes INTEGER NOT NULL, digest BLOB NOT NULL,
        view BLOB NOT NULL, sum INTEGER NOT NULL) STRICT;
    CREATE TABLE part(at INTEGER PRIMARY KEY, bytes BLOB NOT NULL, sum INTEGER NOT NULL) STRICT;
    CREATE TABLE entry(at INTEGER PRIMARY KEY, algorithm INTEGER NOT NULL, sum INTEGER NOT NULL,
        view BLOB NOT NULL, digest BLOB NOT NULL, key BLOB NOT NULL, print BLOB NOT NULL,
        body BLOB NOT NULL) STRICT;
    CREATE TABLE answer(at INTEGER PRIMARY KEY, scope BLOB NOT NULL, key BLOB NOT NULL,
        print BLOB NOT NULL, time INTEGER NOT NULL, sum INTEGER NOT NULL,
        bytes BLOB NOT NULL) STRICT;
    CREATE TABLE probe(at INTEGER PRIMARY KEY, time INTEGER NOT NULL) STRICT;
    PRAGMA application_id = 0x544e534d;
    PRAGMA user_version = 1;
    COMMIT;
)sql";

/// FULL: each commit is synced before it counts. Freed pages are not overwritten with zeros, which
/// Debian's SQLite does by default: the sweeping of an old snapshot would write all of it again.
/// The log is cut to the limit when it begins anew.
constexpr const char* kManners = R"sql(
    PRAGMA synchronous = FULL;
    PRAGMA journal_size_limit = 67108864;
    PRAGMA secure_delete = OFF;
    PRAGMA cell_size_check = ON;
    PRAGMA temp_store = MEMORY;
    PRAGMA cache_size = -16384;
)sql";

using Bytes8 = std::array<char, 8>;

Bytes8 bytes_of(std::uint64_t value) {
    Bytes8 bytes{};
    for (char& byte : bytes) {
        byte = static_cast<char>(value & 0xffU);
        value >>= 8U;
    }
    return bytes;
}

/// Numbers and texts of a row, each in its place.
std::int64_t sum_of_row(std::string_view table, std::initializer_list<std::uint64_t> numbers,
                        std::initializer_list<std::string_view> texts) {
    std::string packed;
    for (const std::uint64_t number : numbers) {
        const Bytes8 bytes = bytes_of(number);
        packed.append(bytes.data(), bytes.size());
    }
    std::vector<std::string_view> parts{table, packed};
    parts.insert(parts.end(), texts);
    const std::string digest = sha256_of(parts);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < 8; ++i)
        sum = (sum << 8U) | static_cast<unsigned char>(digest[i]);
    return static_cast<std::int64_t>(sum);
}

std::uint64_t unsigned_of(std::int64_t value) {
    return static_cast<std::uint64_t>(value);
}

std::string foreign(const std::filesystem::path& file, const std::string& why) {
    return file.string() + " is no store of Tinsmith (" + why +
           "); move it away, or give another folder";
}

/// Empty where the file has a write-ahead log from now on. EXTRA meanwhile: should the power fail,
/// the journal of the change to one could be there again and take it back, and the log with it.
std::string use_log(Database& database, const std::filesystem::path& file) {
    auto fault = database.run("PRAGMA synchronous = EXTRA");
    Statement change = database.prepare("PRAGMA journal_mode = WAL");
    if (!fault && change.step() == Statement::Step::Failed) fault = change.fault();
    // Where the system has no shared memory for its index, SQLite says how it goes on instead.
    const std::string mode = fault ? std::string() : change.bytes(0);
    change.reset();
    if (!fault) fault = database.run("PRAGMA synchronous = FULL");
    if (fault) return file.string() + ": " + fault->text;
    if (mode == "wal") return {};
    return file.string() +
           " can have no write-ahead log, its file system does not let it; give "
           "a folder on a local disk";
}

/// Empty where the file is a store of ours, made now if there was nothing.
std::string check_format(Database& database, const std::filesystem::path& file,
                         Database::Access access) {
    std::array<std::int64_t, 3> found{};
    const std::array<const char*, 3> questions = {"PRAGMA application_id", "PRAGMA user_version",
                                                  "SELECT count(*) FROM sqlite_schema"};
    for (std::size_t i = 0; i < questions.size(); ++i) {
        const auto answer = database.ask(questions[i]);
        if (const auto* fault = std::get_if<DatabaseFault>(&answer)) {
            return fault->kind == DatabaseFault::Kind::Corrupt ? foreign(file, fault->text)
                                                               : file.string() + ": " + fault->text;
        }
        found[i] = std::get<std::int64_t>(answer);
    }
    const auto [application, format, tables] = found;
    if (application == 0 && format == 0 && tables == 0) {
        if (access == Database::Access::Read) return foreign(file, "it is empty");
        if (std::string why = use_log(database, file); !why.empty()) return why;
        const auto fault = database.run(kTables);
        return fault ? file.string() + ": " + fault->text : std::string();
    }
    if (application != kApplication) return foreign(file, "another program made it");
    if (format != kFormat)
        return file.string() + " has format " + std::to_string(format) +
               ", and this program knows format " + std::to_string(kFormat) +
               ": it was written by a newer Tinsmith, use that one";
    return access == Database::Access::Write ? use_log(database, file) : std::string();
}

}  // namespace

std::int64_t sum_of(const JournalEntry& entry) {
    return sum_of_row("entry", {entry.version, entry.algorithm},
                      {entry.birth, entry.body, entry.digest, entry.key, entry.print, entry.view});
}

std::int64_t sum_of_part(std::string_view birth, std::int64_t key, std::string_view bytes) {
    return sum_of_row("part", {unsigned_of(key)}, {birth, bytes});
}

std::int64_t sum_of(std::int64_t number, const StoredFacts& session) {
    return sum_of_row("session", {unsigned_of(number), unsigned_of(session.used)},
                      {session.birth, session.id, session.facts, session.key, session.print});
}

std::int64_t sum_of(std::int64_t number, std::string_view birth, const SnapshotRow& snapshot) {
    const SnapshotHead& head = snapshot.head;
    return sum_of_row(
        "snapshot",
        {unsigned_of(number), unsigned_of(snapshot.number), unsigned_of(snapshot.parts),
         head.version, head.algorithm, head.format, head.bytes},
        {birth, head.digest, head.view});
}

std::int64_t sum_of(std::int64_t number, const UsedRow& used) {
    return sum_of_row("used", {unsigned_of(number), unsigned_of(used.time), used.newest}, {});
}

std::int64_t sum_of(const KeptAnswerRow& answer) {
    return sum_of_row("answer", {unsigned_of(answer.time)},
                      {answer.scope, answer.key, answer.print, answer.bytes});
}

std::filesystem::path database_file(const std::filesystem::path& folder) {
    return folder / "tinsmith.db";
}

std::filesystem::path log_file(const std::filesystem::path& folder) {
    return folder / "tinsmith.db-wal";
}

Database::Opened open_again(const std::filesystem::path& folder, Database::Access access,
                            const std::string& vfs) {
    Database::Opened opened = Database::open(database_file(folder), access, vfs);
    if (auto* database = std::get_if<Database>(&opened)) {
        if (auto fault = database->run(kManners)) return std::move(*fault);
    }
    return opened;
}

std::variant<Database, std::string> open_database(const std::filesystem::path& folder,
                                                  Database::Access access, const std::string& vfs) {
    const std::filesystem::path file = database_file(folder);
    if (!database_is_threadsafe())
        return std::string("this SQLite was built without threads; use another one");
    Database::Opened opened = open_again(folder, access, vfs);
    if (const auto* fault = std::get_if<DatabaseFault>(&opened)) {
        return fault->kind == DatabaseFault::Kind::Corrupt ? foreign(file, fault->text)
                                                           : file.string() + ": " + fault->text;
    }
    Database& database = std::get<Database>(opened);
    if (std::string why = check_format(database, file, access); !why.empty()) return why;
    return std::move(database);
}

JournalFault fault_from(const DatabaseFault& fault, const std::string& doing) {
    JournalFault::Kind kind = JournalFault::Kind::Io;
    switch (fault.kind) {
        case DatabaseFault::Kind::Full:
            kind = JournalFault::Kind::DiskFull;
            break;
        case DatabaseFault::Kind::Io:
            kind = JournalFault::Kind::Io;
            break;
        case DatabaseFault::Kind::Corrupt:
            kind = JournalFault::Kind::Damaged;
            break;
        case DatabaseFault::Kind::Taken:
            kind = JournalFault::Kind::Conflict;
            break;
    }
    return {kind, doing + ": " + fault.text};
}

}  // namespace tinsmith::server::store
