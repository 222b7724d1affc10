// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

struct sqlite3;
struct sqlite3_stmt;

namespace tinsmith::server::store {

/// What SQLite refused, and why.
struct DatabaseFault {
    enum class Kind {
        Full,     ///< no room on the disk, or for this user
        Io,       ///< the system refused
        Corrupt,  ///< the file is not what SQLite wrote
        Taken,    ///< a row with that key is there
    };
    Kind kind = Kind::Io;
    std::string text;

    /// Whether rows are to blame, those of one session perhaps, and not the disk.
    bool is_of_rows() const { return kind == Kind::Corrupt || kind == Kind::Taken; }
};

/// A prepared statement, used again and again: bind all, step until it is done. It starts over by
/// itself where it was stepped to its end; else `reset` does it. Bytes that are bound have to
/// outlive the steps. Requires: the database outlives it.
class Statement {
  public:
    enum class Step { Row, Done, Failed };

    Statement() = default;
    Statement(sqlite3* database, const char* sql);

    Statement& bind(int place, std::int64_t value);
    Statement& bind(int place, std::string_view bytes);
    Step step();
    void reset();
    /// Steps to the end of what answers no rows.
    std::optional<DatabaseFault> run();

    /// Of the row that the last step came to; columns count from 0.
    std::int64_t integer(int column) const;
    std::string bytes(int column) const;

    /// Why the last step failed.
    const DatabaseFault& fault() const { return fault_; }

  private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    void note_fault(int code);

    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    DatabaseFault fault_;
};

/// One connection, used by one thread at a time. The one home of SQLite; nothing here throws but
/// std::bad_alloc.
class Database {
  public:
    enum class Access { Write, Read };
    using Opened = std::variant<Database, DatabaseFault>;

    /// Write makes the file where it is not there. An empty name for the usual file system.
    static Opened open(const std::filesystem::path& file, Access access, const std::string& vfs);

    /// Any number of statements that answer nothing.
    std::optional<DatabaseFault> run(const char* sql);
    /// The first column of the first row, 0 where there is none.
    std::variant<std::int64_t, DatabaseFault> ask(const char* sql);
    Statement prepare(const char* sql) const { return {database_.get(), sql}; }

    /// Whether a transaction is open.
    bool in_transaction() const;

    /// Moves what it can from the log into the file; waits for no reader.
    std::optional<DatabaseFault> checkpoint();
    /// Pages of the log that the last commit has left to be moved. Asked after each commit.
    int pages_to_move();

    /// Copies all of it as it is at one moment into a new file.
    std::optional<DatabaseFault> copy_to(const std::filesystem::path& file);

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    Database() = default;

    std::unique_ptr<int> log_pages_;  ///< where SQLite's hook writes it, wherever this is moved
    int moved_pages_ = 0;             ///< of those
    std::unique_ptr<sqlite3, Close> database_;
};

/// Whether this program's SQLite is one that may be used by several threads.
bool database_is_threadsafe();

}  // namespace tinsmith::server::store
