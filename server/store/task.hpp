// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "server/store/layout.hpp"
#include "server/store/rows.hpp"

namespace tinsmith::server::store {

struct AddEntry {
    JournalEntry entry;
    std::int64_t sum = 0;
};

/// Its bytes outlive the task.
struct AddPart {
    std::int64_t key = 0;
    std::string_view bytes;
    std::int64_t sum = 0;
};

/// The last part of a snapshot, and with it the snapshot counts.
struct Publish {
    std::optional<StoredFacts> made;  ///< of a new session
    std::int64_t number = 0;          ///< of that one
    SnapshotRow snapshot;
    AddPart last_part;
    std::deque<KeptAnswerRow> answers;  ///< stored with it, or it is not
};

struct Remove {};

/// Something to be committed, whose caller waits.
struct Task {
    std::string birth;
    std::variant<AddEntry, AddPart, Publish, Remove> what;
    std::promise<Committed> done;
    std::optional<JournalFault> refusal;  ///< while it is worked on: its own, not the disk's

    std::size_t entries() const { return std::holds_alternative<AddEntry>(what) ? 1 : 0; }

    std::size_t bytes() const {
        if (const auto* add = std::get_if<AddEntry>(&what)) {
            const JournalEntry& entry = add->entry;
            return sizeof(Task) + entry.body.size() + entry.view.size() + entry.digest.size() +
                   entry.key.size() + entry.print.size();
        }
        if (const auto* part = std::get_if<AddPart>(&what)) return part->bytes.size();
        if (const auto* last = std::get_if<Publish>(&what)) return last->last_part.bytes.size();
        return 0;
    }
};

}  // namespace tinsmith::server::store
