// SPDX-License-Identifier: Apache-2.0
#include "server/routes/restored_answers.hpp"

#include <map>
#include <utility>

#include "server/archive/packing.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"
#include "server/unix_time.hpp"

namespace tinsmith::server {

template <>
struct Parts<Response> {
    static void each(auto& response, auto visit) {
        visit(response.status, response.content_type, response.headers, response.body);
    }
};

namespace {

constexpr int kAccepted = 202;
/// A larger one is told as its report once the process that sent it has ended.
constexpr std::size_t kLargestStored = std::size_t{256} << 10;
constexpr std::chrono::hours kAge{24};

/// A job ends with the process that promised it.
bool is_stored(const Response& answer) {
    return answer.status != kAccepted && answer.body.size() <= kLargestStored;
}

std::string packed(const Response& answer) {
    Packer pack;
    pack(answer);
    return pack.take();
}

}  // namespace

void store_answers(Services& services) {
    Journal& journal = services.vault->journal();
    services.answers.when_kept = [&journal](const KeptAnswers::Name& name, const std::string& print,
                                            const Response& answer) {
        if (is_stored(answer))
            journal.keep_answer({name.first, name.second, print, unix_seconds(), packed(answer)});
    };
    services.vault->answer_of = [&services](const Session& session, const KeyedChange& keyed,
                                            std::size_t most) -> std::optional<std::string> {
        const auto first = services.answers.find({session.facts().birth, keyed.key});
        if (first && is_stored(*first) && first->body.size() <= most) return packed(*first);
        const auto copy = session.change_at(keyed.version);
        const auto* change = std::get_if<ChangeCopy>(&copy);
        if (change == nullptr) return std::nullopt;
        return packed(tell_change(session, *change));
    };
    services.sessions.when_loaded = [&services](const LoadedSession& loaded) {
        const Session& session = *loaded.session;
        for (const auto& [version, key, print] : loaded.keyed) {
            const auto copy = session.change_at(version);
            if (const auto* change = std::get_if<ChangeCopy>(&copy))
                services.answers.restore({session.facts().birth, key}, print,
                                         tell_change(session, *change), {});
        }
    };
}

void restore_answers(Services& services) {
    Journal& journal = services.vault->journal();
    const std::int64_t now = unix_seconds();
    const auto age = std::chrono::duration_cast<std::chrono::seconds>(kAge).count();
    journal.forget_answers(now - age);
    auto stored = journal.answers(now - age);
    if (const auto* fault = std::get_if<JournalFault>(&stored)) throw StorageFault(fault->text);
    const auto& rows = std::get<0>(stored);
    std::map<KeptAnswers::Name, std::size_t> last;  // of one name it counts
    for (std::size_t i = 0; i < rows.size(); ++i)
        last[{rows[i].scope, rows[i].key}] = i;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const KeptAnswerRow& row = rows[i];
        if (last[{row.scope, row.key}] != i) continue;
        Response answer;
        Unpacker unpack(row.bytes);
        unpack(answer);
        if (!unpack.done()) continue;  // of another release
        services.answers.restore({row.scope, row.key}, row.print, answer,
                                 std::chrono::seconds(std::max<std::int64_t>(now - row.time, 0)));
    }
    for (const VaultEntry& made : services.vault->entries()) {
        if (made.made_by.key.empty() || !made.damage.empty()) continue;
        services.answers.restore({made.made_by.scope, made.made_by.key}, made.made_by.print,
                                 tell_created(view_of(made.facts, made.counts), made.facts.birth),
                                 {});
    }
}

}  // namespace tinsmith::server
