// SPDX-License-Identifier: Apache-2.0
#include "server/store/journal.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <memory>
#include <new>
#include <system_error>
#include <tuple>
#include <utility>

#include "server/store/catalog.hpp"
#include "server/store/folder_lock.hpp"
#include "server/store/layout.hpp"
#include "server/store/pulse.hpp"
#include "server/store/reading.hpp"
#include "server/store/row_reader.hpp"
#include "server/store/writer.hpp"

namespace tinsmith::server {

namespace {

using store::Catalog;
using store::FolderLock;
using store::Inventory;
using store::Pulse;
using store::Task;
using store::Writer;

/// Parts of one snapshot that are under way: the next one is summed up while one is written.
constexpr std::size_t kPartsAtATime = 2;

JournalFault fault(JournalFault::Kind kind, std::string text) {
    return {kind, std::move(text)};
}

JournalFault closed() {
    return fault(JournalFault::Kind::Closed, "the journal is closed");
}

std::uint64_t size_of(const std::filesystem::path& file) {
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(file, code);
    return code ? 0 : size;
}

/// Nothing: it can be kept in a row.
Committed too_large(std::size_t bytes, const std::string& birth) {
    if (bytes <= store::kLargestRow) return std::nullopt;
    return fault(JournalFault::Kind::Conflict,
                 store::place_of("a row of " + std::to_string(bytes) + " bytes", birth) +
                     " is larger than the " + std::to_string(store::kLargestRow) +
                     " that can be stored");
}

/// Parts that the writer reads from the caller's bytes: they are waited for, whatever happens.
class UnderWay {
  public:
    UnderWay() = default;
    UnderWay(const UnderWay&) = delete;
    UnderWay& operator=(const UnderWay&) = delete;
    ~UnderWay() {
        for (const auto& part : parts_)
            part.wait();
    }
    bool empty() const { return parts_.empty(); }
    std::size_t size() const { return parts_.size(); }
    void add(std::future<Committed> part) { parts_.push_back(std::move(part)); }
    Committed wait_for_first() {
        Committed done = parts_.front().get();
        parts_.pop_front();
        return done;
    }

  private:
    std::deque<std::future<Committed>> parts_;
};

}  // namespace

class Journal::Implementation {
  public:
    Implementation(JournalOptions options, FolderLock lock, store::Database database,
                   const Inventory& inventory)
        : options_(std::move(options)),
          lock_(std::move(lock)),
          catalog_(inventory),
          writer_(options_, std::move(database), inventory, catalog_, pulse_) {}

    Committed append(JournalEntry entry);
    Committed create(const StoredFacts& session, const SnapshotHead& head, std::string_view bytes);
    Committed write_snapshot(const std::string& birth, const SnapshotHead& head,
                             std::string_view bytes, std::vector<KeptAnswerRow> answers);
    Committed remove(const std::string& birth);
    std::variant<std::vector<SessionRow>, JournalFault> sessions() const;
    std::variant<StoredSession, JournalFault> read(const std::string& birth) const;
    std::variant<std::vector<KeptAnswerRow>, JournalFault> answers(std::int64_t newer_than) const;
    JournalFigures figures() const;
    void close();

    Writer& writer() { return writer_; }
    JournalHealth health() const { return pulse_.health(); }

  private:
    Committed write_parts(const std::string& birth, store::Publish publish, std::string_view bytes);
    store::Database::Opened open_to_read() const {
        return store::open_again(options_.folder, store::Database::Access::Read, options_.vfs);
    }

    const JournalOptions options_;
    FolderLock lock_;
    Catalog catalog_;
    Pulse pulse_;
    std::atomic<bool> is_closed_{false};
    Writer writer_;  // ends before what it works on
};

Committed Journal::Implementation::append(JournalEntry entry) {
    const std::size_t bytes = entry.body.size() + entry.view.size() + entry.digest.size() +
                              entry.key.size() + entry.print.size();
    if (auto refused = too_large(bytes, entry.birth)) return refused;
    auto task = std::make_unique<Task>();
    task->birth = entry.birth;
    const std::int64_t sum = store::sum_of(entry);
    task->what = store::AddEntry{std::move(entry), sum};
    return writer_.submit(std::move(task)).get();
}

Committed Journal::Implementation::create(const StoredFacts& session, const SnapshotHead& head,
                                          std::string_view bytes) {
    if (head.version > store::kLastVersion)
        return fault(JournalFault::Kind::Conflict, "the version is beyond 2^36");
    if (auto refused = too_large(session.facts.size() + head.view.size(), session.birth))
        return refused;
    store::Publish publish;
    publish.made = session;
    publish.number = catalog_.new_session();
    publish.snapshot.head = head;
    if (auto refused = catalog_.reserve(session)) return refused;
    try {
        Committed outcome = write_parts(session.birth, std::move(publish), bytes);
        if (outcome) catalog_.release(session);
        return outcome;
    } catch (...) {
        catalog_.release(session);
        throw;
    }
}

Committed Journal::Implementation::write_snapshot(const std::string& birth,
                                                  const SnapshotHead& head, std::string_view bytes,
                                                  std::vector<KeptAnswerRow> answers) {
    if (auto refused = too_large(head.view.size() + head.digest.size(), birth)) return refused;
    if (!catalog_.find(birth)) return store::gone(birth);
    store::Publish publish;
    publish.snapshot.head = head;
    publish.answers.assign(std::make_move_iterator(answers.begin()),
                           std::make_move_iterator(answers.end()));
    return write_parts(birth, std::move(publish), bytes);
}

/// All parts but the last by themselves, then the last one with what makes them count.
Committed Journal::Implementation::write_parts(const std::string& birth, store::Publish publish,
                                               std::string_view bytes) {
    const std::size_t part_bytes =
        std::clamp(options_.part_bytes, std::size_t{1}, store::kLargestRow);
    const std::size_t parts =
        std::max<std::size_t>(1, (bytes.size() + part_bytes - 1) / part_bytes);
    if (parts > store::kMostParts)
        return fault(
            JournalFault::Kind::Conflict,
            store::place_of("a snapshot of " + std::to_string(bytes.size()) + " bytes", birth) +
                " is too large");
    const std::int64_t number = catalog_.new_snapshot();
    publish.snapshot.number = number;
    publish.snapshot.parts = static_cast<std::int64_t>(parts);
    publish.snapshot.head.bytes = bytes.size();

    Committed outcome;
    UnderWay under_way;
    const auto wait_for_one = [&outcome, &under_way] {
        Committed done = under_way.wait_for_first();
        if (done && !outcome) outcome = std::move(done);
    };
    for (std::size_t i = 0; i < parts && !outcome; ++i) {
        auto task = std::make_unique<Task>();
        task->birth = birth;
        store::AddPart part{store::part_key(number, i), bytes.substr(i * part_bytes, part_bytes),
                            0};
        part.sum = store::sum_of_part(birth, part.key, part.bytes);
        if (i + 1 < parts) {
            task->what = part;
        } else {
            // The others are there, each of them, or this one is not asked for.
            while (!under_way.empty())
                wait_for_one();
            if (outcome) break;
            // NOLINTNEXTLINE(bugprone-use-after-move): the last turn
            publish.last_part = part;
            task->what = std::move(publish);
        }
        under_way.add(writer_.submit_large(std::move(task)));
        if (under_way.size() >= kPartsAtATime) wait_for_one();
    }
    while (!under_way.empty())
        wait_for_one();
    if (outcome) writer_.give_up(store::parts_of(number));
    return outcome;
}

Committed Journal::Implementation::remove(const std::string& birth) {
    auto task = std::make_unique<Task>();
    task->birth = birth;
    task->what = store::Remove{};
    return writer_.submit(std::move(task)).get();
}

std::variant<std::vector<SessionRow>, JournalFault> Journal::Implementation::sessions() const {
    if (is_closed_) return closed();
    auto opened = open_to_read();
    if (const auto* refused = std::get_if<store::DatabaseFault>(&opened))
        return store::fault_from(*refused, "opening the store to read");
    auto listed = store::list_sessions(std::get<store::Database>(opened));
    if (auto* refused = std::get_if<JournalFault>(&listed)) return std::move(*refused);
    std::vector<SessionRow> rows;
    for (store::Listed& one : std::get<std::vector<store::Listed>>(listed)) {
        // What a commit came upon, a look at the newest rows may not.
        const auto refused = catalog_.why_not(one.row.session.birth);
        if (one.row.damage.empty() && refused && refused->kind == JournalFault::Kind::Damaged)
            one.row.damage = refused->text;
        rows.push_back(std::move(one.row));
    }
    return rows;
}

std::variant<StoredSession, JournalFault> Journal::Implementation::read(
    const std::string& birth) const {
    if (is_closed_) return closed();
    for (;;) {
        const auto known = catalog_.find(birth);
        if (!known) return store::gone(birth);
        auto opened = open_to_read();
        if (const auto* refused = std::get_if<store::DatabaseFault>(&opened))
            return store::fault_from(*refused, "opening the store to read");
        const std::uint64_t most = size_of(store::database_file(options_.folder)) +
                                   size_of(store::log_file(options_.folder));
        auto stored = store::read_session(std::get<store::Database>(opened), known->number, birth,
                                          known->newest, most);
        if (std::holds_alternative<StoredSession>(stored)) return stored;
        // Removed or moved since the look into the catalog: that is no damage. A session is moved
        // once or twice in its life.
        const auto now = catalog_.find(birth);
        if (now && now->number == known->number) return stored;
    }
}

std::variant<std::vector<KeptAnswerRow>, JournalFault> Journal::Implementation::answers(
    std::int64_t newer_than) const {
    if (is_closed_) return closed();
    auto opened = open_to_read();
    if (const auto* refused = std::get_if<store::DatabaseFault>(&opened))
        return store::fault_from(*refused, "opening the store to read");
    return store::read_answers(std::get<store::Database>(opened), newer_than);
}

JournalFigures Journal::Implementation::figures() const {
    JournalFigures figures = pulse_.figures();
    std::tie(figures.queued_entries, figures.queued_bytes) = writer_.queued();
    figures.file_bytes = size_of(store::database_file(options_.folder));
    figures.log_bytes = size_of(store::log_file(options_.folder));
    return figures;
}

void Journal::Implementation::close() {
    writer_.close();
    is_closed_ = true;
}

std::variant<std::unique_ptr<Journal>, std::string> Journal::open(const JournalOptions& options) {
    auto locked = FolderLock::take(options.folder);
    if (auto* why = std::get_if<std::string>(&locked)) return std::move(*why);
    auto opened = store::open_database(options.folder, store::Database::Access::Write, options.vfs);
    if (auto* why = std::get_if<std::string>(&opened)) return std::move(*why);
    auto& database = std::get<store::Database>(opened);
    auto taken = store::take_inventory(database);
    if (const auto* refused = std::get_if<JournalFault>(&taken)) return refused->text;
    return std::unique_ptr<Journal>(new Journal(std::make_unique<Implementation>(
        options, std::move(std::get<FolderLock>(locked)), std::move(database),
        std::move(std::get<Inventory>(taken)))));
}

Journal::Journal(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

Journal::~Journal() {
    close();
}

Committed Journal::append(JournalEntry entry) {
    return implementation_->append(std::move(entry));
}

Committed Journal::create(const StoredFacts& session, const SnapshotHead& head,
                          std::string_view bytes) {
    return implementation_->create(session, head, bytes);
}

Committed Journal::write_snapshot(const std::string& birth, const SnapshotHead& head,
                                  std::string_view bytes, std::vector<KeptAnswerRow> answers) {
    return implementation_->write_snapshot(birth, head, bytes, std::move(answers));
}

Committed Journal::remove(const std::string& birth) {
    return implementation_->remove(birth);
}

void Journal::touch(const std::string& birth, std::int64_t unix_seconds) noexcept {
    try {
        implementation_->writer().touch(birth, unix_seconds);
    } catch (const std::bad_alloc&) {
        // It is as if it had been lost with the power.
    }
}

void Journal::keep_answer(KeptAnswerRow answer) noexcept {
    try {
        implementation_->writer().keep_answer(std::move(answer));
    } catch (const std::bad_alloc&) {
        // As above.
    }
}

std::variant<std::vector<SessionRow>, JournalFault> Journal::sessions() const {
    return implementation_->sessions();
}

std::variant<StoredSession, JournalFault> Journal::read(const std::string& birth) const {
    return implementation_->read(birth);
}

std::variant<std::vector<KeptAnswerRow>, JournalFault> Journal::answers(
    std::int64_t newer_than_unix_seconds) const {
    return implementation_->answers(newer_than_unix_seconds);
}

void Journal::forget_answers(std::int64_t older_than_unix_seconds) noexcept {
    try {
        implementation_->writer().forget_answers(older_than_unix_seconds);
    } catch (const std::bad_alloc&) {
        // They are forgotten the next time.
    }
}

JournalHealth Journal::health() const {
    return implementation_->health();
}

JournalFigures Journal::figures() const {
    return implementation_->figures();
}

void Journal::close() noexcept {
    implementation_->close();
}

}  // namespace tinsmith::server
