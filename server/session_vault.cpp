// SPDX-License-Identifier: Apache-2.0
#include "server/session_vault.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <mutex>
#include <utility>

#include "core/types/algorithm.hpp"
#include "server/archive/session_archive.hpp"
#include "server/mesh_digest.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

namespace {

[[noreturn]] void throw_fault(const JournalFault& fault) {
    switch (fault.kind) {
        case JournalFault::Kind::Gone:
            throw SessionIsGone(fault.text);
        case JournalFault::Kind::Damaged:
            throw SessionIsDamaged(fault.text);
        case JournalFault::Kind::DiskFull:
        case JournalFault::Kind::Io:
        case JournalFault::Kind::Closed:
        case JournalFault::Kind::Conflict:
            break;
    }
    throw StorageFault(fault.text);
}

void require(const Committed& committed) {
    if (committed) throw_fault(*committed);
}

/// Scope and key as one text: neither has a line's end.
std::string stored_key(const RequestKey& key) {
    return key.key.empty() ? std::string() : key.scope + '\n' + key.key;
}
RequestKey key_of(std::string_view stored, std::string print) {
    const std::size_t end = stored.find('\n');
    if (end == std::string_view::npos) return {};
    return {std::string(stored.substr(end + 1)), std::move(print),
            std::string(stored.substr(0, end))};
}

/// No key's id. What is damaged so that nobody knows whose it was is shown to no key.
constexpr const char* kNobody = "?";

/// Bytes of whole answers that go with one snapshot; of more, what is told of the changes.
constexpr std::size_t kAnswersOfASnapshot = std::size_t{16} << 20;

/// Takes no changes.
class ReadOnlyLog : public ChangeLog {
  public:
    explicit ReadOnlyLog(std::string why) : why_(std::move(why)) {}
    void keep(const LoggedChange&) override { throw SessionIsReadOnly(why_); }

  private:
    const std::string why_;
};

SnapshotHead head_of(const SessionParts& parts, const SessionCounts& counts) {
    SnapshotHead head;
    head.version = parts.history.version();
    head.algorithm = core::kAlgorithm;
    head.format = kArchiveFormat;
    head.digest = whole_digest(parts.tin);
    head.view = pack(counts);
    return head;
}

}  // namespace

/// Of one session. Its changes come one at a time; a snapshot may be taken beside them.
class SessionVault::Log : public ChangeLog {
  public:
    Log(SessionVault& vault, SessionFacts facts) : vault_(vault), facts_(std::move(facts)) {}

    void keep(const LoggedChange& change) override {
        const RequestKey& key = current_request_key();
        JournalEntry entry{change.birth,       change.counts.version, core::kAlgorithm,
                           pack(change.asked), change.digest,         key.key,
                           key.print,          pack(change.counts)};
        const std::size_t bytes = entry.body.size() + entry.view.size();
        require(vault_.journal_->append(std::move(entry)));
        count(bytes, change.seconds);
        if (!key.key.empty()) add_keyed({change.counts.version, key.key, key.print});
        tell_if_due();
    }

    /// A change whose key the journal knows by its entry alone, perhaps.
    void add_keyed(KeyedChange change) {
        const std::lock_guard lock(mutex_);
        keyed_.push_back(std::move(change));
    }

    /// Those up to a version, oldest first, which leave the list.
    std::vector<KeyedChange> take_keyed(std::uint64_t version) {
        const std::lock_guard lock(mutex_);
        const auto end = std::ranges::find_if(
            keyed_, [version](const KeyedChange& change) { return change.version > version; });
        std::vector<KeyedChange> taken(std::make_move_iterator(keyed_.begin()),
                                       std::make_move_iterator(end));
        keyed_.erase(keyed_.begin(), end);
        return taken;
    }

    void count(std::size_t bytes, double seconds) {
        ++entries_;
        bytes_ += bytes;
        seconds_ = seconds_ + seconds;
    }

    void tell_if_due() {
        const TailBounds& most = vault_.tail_;
        const bool is_due =
            entries_ >= most.entries || bytes_ >= most.bytes || seconds_ >= most.seconds;
        if (is_due && !is_told_.exchange(true) && vault_.when_due) vault_.when_due(facts_.id);
    }

    struct Tail {
        std::size_t entries = 0;
        std::size_t bytes = 0;
        double seconds = 0.0;
    };

    /// A snapshot holds what came before it; what comes meanwhile counts anew. Returns what came
    /// before.
    Tail begin_snapshot() {
        const Tail tail{entries_.exchange(0), bytes_.exchange(0), seconds_.exchange(0.0)};
        is_told_ = false;
        return tail;
    }
    /// It came to nothing. Whoever asked for the snapshot knows, and is not told again.
    void give_back(const Tail& tail, std::vector<KeyedChange> keyed) {
        const std::lock_guard lock(mutex_);
        keyed_.insert(keyed_.begin(), std::make_move_iterator(keyed.begin()),
                      std::make_move_iterator(keyed.end()));
        entries_ += tail.entries;
        bytes_ += tail.bytes;
        seconds_ = seconds_ + tail.seconds;
        is_told_ = true;
    }
    bool has_tail() const { return entries_ > 0; }

  private:
    SessionVault& vault_;
    const SessionFacts facts_;
    std::atomic<std::size_t> entries_{0};
    std::atomic<std::size_t> bytes_{0};
    std::atomic<double> seconds_{0.0};
    std::atomic<bool> is_told_{false};
    std::mutex mutex_;
    std::deque<KeyedChange> keyed_;  ///< since the snapshot, oldest first
};

std::variant<std::unique_ptr<SessionVault>, std::string> SessionVault::open(
    const JournalOptions& options, HistoryLimits history, TailBounds tail) {
    auto journal = Journal::open(options);
    if (auto* why = std::get_if<std::string>(&journal)) return std::move(*why);
    return std::unique_ptr<SessionVault>(
        new SessionVault(std::get<0>(std::move(journal)), history, tail));
}

SessionVault::SessionVault(std::unique_ptr<Journal> journal, HistoryLimits history, TailBounds tail)
    : journal_(std::move(journal)), history_(history), tail_(tail) {}

std::vector<VaultEntry> SessionVault::entries() const {
    auto rows = journal_->sessions();
    if (const auto* fault = std::get_if<JournalFault>(&rows)) throw_fault(*fault);
    std::vector<VaultEntry> list;
    for (SessionRow& row : std::get<0>(rows)) {
        VaultEntry entry;
        entry.used = row.session.used;
        entry.made_by = key_of(row.session.key, std::move(row.session.print));
        entry.tail = row.version - row.snapshot_version;
        entry.damage = std::move(row.damage);
        auto facts = unpack_facts(row.session.facts, entry.owner);
        auto counts = unpack_counts(row.view);
        if (facts) entry.facts = std::move(*facts);
        if (!facts) entry.owner = kNobody;
        if (counts) entry.counts = *counts;
        entry.facts.id = std::move(row.session.id);
        entry.facts.birth = std::move(row.session.birth);
        if (entry.damage.empty() && (!facts || !counts))
            entry.damage = "What is stored of it was written by another release of Tinsmith.";
        list.push_back(std::move(entry));
    }
    return list;
}

std::shared_ptr<SessionVault::Log> SessionVault::log_of(const SessionFacts& facts) {
    return std::make_shared<Log>(*this, facts);
}

void SessionVault::create(Session& session, const std::string& owner) {
    const SessionFacts& facts = session.facts();
    const auto log = log_of(facts);
    session.start_log(log);
    const SessionParts parts = session.parts();
    const RequestKey& key = current_request_key();
    require(journal_->create(
        {facts.birth, facts.id, pack(facts, owner), stored_key(key), key.print, unix_seconds()},
        head_of(parts, session.counts()), pack(parts)));
}

LoadedSession SessionVault::load(const std::string& birth) {
    auto read = journal_->read(birth);
    if (const auto* fault = std::get_if<JournalFault>(&read)) throw_fault(*fault);
    StoredSession& stored = std::get<0>(read);
    if (stored.head.format != kArchiveFormat)
        throw SessionIsDamaged("Its snapshot has the form " + std::to_string(stored.head.format) +
                               " of another release of Tinsmith; this one reads form " +
                               std::to_string(kArchiveFormat) + ".");
    auto image = unpack_image(stored.bytes, history_);
    stored.bytes = {};
    if (!image || image->history.version() != stored.head.version ||
        whole_digest(image->tin) != stored.head.digest)
        throw SessionIsDamaged("Its snapshot of version " + std::to_string(stored.head.version) +
                               " is not what its digest says.");
    if (stored.head.algorithm != core::kAlgorithm) image->history.settle();
    LoadedSession loaded;
    loaded.session = std::make_shared<Session>(std::move(*image));
    const auto other = std::ranges::find_if(
        stored.tail, [](const JournalEntry& entry) { return entry.algorithm != core::kAlgorithm; });
    if (other != stored.tail.end()) {
        // The page knows it by how it begins.
        loaded.read_only =
            "This session is read-only: it is as version " + std::to_string(stored.head.version) +
            " was. Later changes, up to " + std::to_string(stored.tail.back().version) +
            ", were made by algorithm " + std::to_string(other->algorithm) +
            " of the core, and this program has algorithm " + std::to_string(core::kAlgorithm) +
            ". Start the release that made them, stop it in order, and it leaves a "
            "snapshot that this one can go on from.";
        loaded.session->add_note(loaded.read_only);
        loaded.session->start_log(std::make_shared<ReadOnlyLog>(loaded.read_only));
        return loaded;
    }
    const auto log = log_of(loaded.session->facts());
    for (JournalEntry& entry : stored.tail) {
        const auto asked = unpack_asked(entry.body);
        if (!asked)
            throw SessionIsDamaged("The change that made version " + std::to_string(entry.version) +
                                   " is not one that this release reads.");
        const auto begin = std::chrono::steady_clock::now();
        if (const auto fault = loaded.session->repeat(*asked, entry.version, entry.digest))
            throw SessionIsDamaged(*fault);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        log->count(entry.body.size() + entry.view.size(), took.count());
        ++loaded.repeated;
        if (entry.key.empty()) continue;
        loaded.keyed.push_back({entry.version, std::move(entry.key), std::move(entry.print)});
        log->add_keyed(loaded.keyed.back());
    }
    loaded.session->start_log(log);
    return loaded;
}

void SessionVault::tell_if_due(const Session& session) {
    if (const auto log = std::dynamic_pointer_cast<Log>(session.log())) log->tell_if_due();
}

void SessionVault::remove(const std::string& birth) {
    const auto committed = journal_->remove(birth);
    if (committed && committed->kind != JournalFault::Kind::Gone) throw_fault(*committed);
}

/// What tells of the keys of changes once a snapshot has taken the place of their entries.
std::vector<KeptAnswerRow> SessionVault::answers_to(const Session& session,
                                                    std::span<const KeyedChange> changes) const {
    std::vector<KeptAnswerRow> answers;
    if (!answer_of) return answers;
    std::size_t left = kAnswersOfASnapshot;
    for (const KeyedChange& change : changes) {
        auto answer = answer_of(session, change, left);
        if (!answer) continue;
        left -= std::min(left, answer->size());
        answers.push_back(
            {session.facts().birth, change.key, change.print, unix_seconds(), std::move(*answer)});
    }
    return answers;
}

void SessionVault::snapshot(const Session& session) {
    const auto log = std::dynamic_pointer_cast<Log>(session.log());
    if (!log || !log->has_tail()) return;
    const Log::Tail tail = log->begin_snapshot();
    std::vector<KeyedChange> keyed;
    try {
        std::string bytes;
        SnapshotHead head;
        {
            const SessionImage image = session.image();
            head = head_of(image.parts(), session.counts());
            bytes = pack(image.parts());
        }
        keyed = log->take_keyed(head.version);
        require(journal_->write_snapshot(session.facts().birth, head, bytes,
                                         answers_to(session, keyed)));
    } catch (...) {
        log->give_back(tail, std::move(keyed));
        throw;
    }
}

}  // namespace tinsmith::server
