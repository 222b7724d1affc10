// SPDX-License-Identifier: Apache-2.0
// The one file that knows SQLite.
#include "server/store/database.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include <sqlite3.h>

namespace tinsmith::server::store {

namespace {

/// How long another program that writes to the file is waited for.
constexpr int kPatienceMs = 5000;

std::string words_for(sqlite3* database, int code) {
    std::string text = database == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(database);
    const int error = database == nullptr ? 0 : sqlite3_system_errno(database);
    const int kind = code & 0xff;
    const bool of_system = kind == SQLITE_IOERR || kind == SQLITE_FULL || kind == SQLITE_CANTOPEN;
    if (of_system && error != 0) text += std::string(", ") + std::strerror(error);
    return text + " (SQLite code " + std::to_string(code) + ")";
}

DatabaseFault fault_of(sqlite3* database, int result) {
    if ((result & 0xff) == SQLITE_NOMEM) throw std::bad_alloc();
    const int code = database == nullptr ? result : sqlite3_extended_errcode(database);
    const int error = database == nullptr ? 0 : sqlite3_system_errno(database);
    DatabaseFault fault;
    fault.text = words_for(database, code);
    switch (code & 0xff) {
        case SQLITE_FULL:
            fault.kind = DatabaseFault::Kind::Full;
            break;
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
        case SQLITE_ERROR:  // of statements that are known to be right: the schema is damaged
        case SQLITE_MISMATCH:
            fault.kind = DatabaseFault::Kind::Corrupt;
            break;
        case SQLITE_CONSTRAINT:
            fault.kind = DatabaseFault::Kind::Taken;
            break;
        case SQLITE_IOERR:
            // SQLite knows ENOSPC of a write alone; quotas and late allocation say it elsewhere.
            fault.kind = error == ENOSPC || error == EDQUOT ? DatabaseFault::Kind::Full
                                                            : DatabaseFault::Kind::Io;
            break;
        default:
            fault.kind = DatabaseFault::Kind::Io;
            break;
    }
    return fault;
}

int note_log_pages(void* place, sqlite3*, const char*, int pages) {
    *static_cast<int*>(place) = pages;
    return SQLITE_OK;
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, const char* sql) {
    sqlite3_stmt* statement = nullptr;
    const int code =
        sqlite3_prepare_v3(database, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
    statement_.reset(statement);
    if (code != SQLITE_OK) fault_ = fault_of(database, code);
}

Statement& Statement::bind(int place, std::int64_t value) {
    if (statement_) sqlite3_bind_int64(statement_.get(), place, value);
    return *this;
}

Statement& Statement::bind(int place, std::string_view bytes) {
    if (!statement_) return *this;
    // A null pointer would be NULL and not the empty bytes.
    const char* data = bytes.data() == nullptr ? "" : bytes.data();
    const int code = sqlite3_bind_blob64(statement_.get(), place, data, bytes.size(),
                                         static_cast<sqlite3_destructor_type>(nullptr));
    // What is too large stays unbound, NULL, which no column takes.
    if (code == SQLITE_NOMEM) throw std::bad_alloc();
    return *this;
}

void Statement::note_fault(int code) {
    fault_ = fault_of(sqlite3_db_handle(statement_.get()), code);
}

Statement::Step Statement::step() {
    if (!statement_) return Step::Failed;  // with the fault of its making
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return Step::Row;
    if (code != SQLITE_DONE) note_fault(code);
    sqlite3_reset(statement_.get());
    return code == SQLITE_DONE ? Step::Done : Step::Failed;
}

void Statement::reset() {
    if (statement_) sqlite3_reset(statement_.get());
}

std::optional<DatabaseFault> Statement::run() {
    Step last = step();
    while (last == Step::Row)
        last = step();
    return last == Step::Failed ? std::optional(fault_) : std::nullopt;
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

std::string Statement::bytes(int column) const {
    const void* data = sqlite3_column_blob(statement_.get(), column);
    const int size = sqlite3_column_bytes(statement_.get(), column);
    if (data == nullptr || size <= 0) return {};
    return {static_cast<const char*>(data), static_cast<std::size_t>(size)};
}

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

Database::Opened Database::open(const std::filesystem::path& file, Access access,
                                const std::string& vfs) {
    const int flags = (access == Access::Write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                                               : SQLITE_OPEN_READONLY) |
                      SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_NOFOLLOW;
    // Of an absolute path: a relative one that looks like an option or a URI would be taken as one.
    std::error_code code;
    const std::filesystem::path folder = std::filesystem::canonical(file.parent_path(), code);
    if (code)
        return DatabaseFault{DatabaseFault::Kind::Io,
                             file.parent_path().string() + ": " + code.message()};
    const std::string path = (folder / file.filename()).string();

    Database result;
    result.log_pages_ = std::make_unique<int>(0);
    sqlite3* database = nullptr;
    const int opened =
        sqlite3_open_v2(path.c_str(), &database, flags, vfs.empty() ? nullptr : vfs.c_str());
    result.database_.reset(database);
    if (opened != SQLITE_OK) return fault_of(database, opened);
    sqlite3_extended_result_codes(database, 1);
    sqlite3_busy_timeout(database, kPatienceMs);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    // In place of the hook that would move the log within a commit: when is the caller's matter.
    // (PRAGMA wal_autocheckpoint, whatever its value, would take this one away.)
    sqlite3_wal_hook(database, note_log_pages, result.log_pages_.get());
    return result;
}

std::optional<DatabaseFault> Database::run(const char* sql) {
    const int code = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) return fault_of(database_.get(), code);
    return std::nullopt;
}

std::variant<std::int64_t, DatabaseFault> Database::ask(const char* sql) {
    Statement statement = prepare(sql);
    const Statement::Step step = statement.step();
    if (step == Statement::Step::Failed) return statement.fault();
    return step == Statement::Step::Row ? statement.integer(0) : 0;
}

bool Database::in_transaction() const {
    return sqlite3_get_autocommit(database_.get()) == 0;
}

int Database::pages_to_move() {
    // Fewer than were moved: the log has begun anew since.
    if (*log_pages_ < moved_pages_) moved_pages_ = 0;
    return *log_pages_ - moved_pages_;
}

std::optional<DatabaseFault> Database::checkpoint() {
    int pages = 0;
    int moved = 0;
    const int code = sqlite3_wal_checkpoint_v2(database_.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE,
                                               &pages, &moved);
    if (code != SQLITE_OK && code != SQLITE_BUSY) return fault_of(database_.get(), code);
    // What readers hold back counts as moved too, or every commit would try again at once.
    *log_pages_ = std::max(pages, 0);
    moved_pages_ = *log_pages_;
    return std::nullopt;
}

std::optional<DatabaseFault> Database::copy_to(const std::filesystem::path& file) {
    Opened opened = open(file, Access::Write, {});
    if (auto* fault = std::get_if<DatabaseFault>(&opened)) return *fault;
    sqlite3* target = std::get<Database>(opened).database_.get();
    sqlite3_backup* backup = sqlite3_backup_init(target, "main", database_.get(), "main");
    if (backup == nullptr) return fault_of(target, SQLITE_ERROR);
    // In one step, which is one look at the source: with more of them, each commit that another
    // process makes between would start it over.
    const int code = sqlite3_backup_step(backup, -1);
    sqlite3_backup_finish(backup);
    if (code == SQLITE_DONE) return std::nullopt;
    return fault_of(nullptr, code);
}

bool database_is_threadsafe() {
    return sqlite3_threadsafe() != 0;
}

}  // namespace tinsmith::server::store
