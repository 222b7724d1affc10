// SPDX-License-Identifier: Apache-2.0
#include "tests/durability/crash_client.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

namespace tinsmith::e2e {

namespace {

using nlohmann::json;

constexpr int kUnavailable = 503;
/// What a client may be told that asks for things which others have changed.
constexpr std::array kOfTheWork{404, 409, 410, 412, 422};

}  // namespace

std::string CrashClient::new_key() {
    return "c" + std::to_string(number_) + "-" + std::to_string(++keys_);
}

Intent CrashClient::polygons(const std::string& session, const Extent& where) {
    Intent intent{.session = session, .method = "POST", .path = "/polygons"};
    const bool is_large = where.width > Slots::kPosts;
    const double x = where.min_x + where.width * dice_.between(0.1, 0.9);
    const double y = where.min_y + where.height * dice_.between(0.1, 0.9);
    const double radius = where.width * dice_.between(0.01, is_large ? 0.05 : 0.12);
    if (dice_.chance(0.25)) {
        const double to_x = x + radius * dice_.between(-1, 1);
        intent.body = R"({"type":"LineString","coordinates":[)" + position_text(x, y) + "," +
                      position_text(to_x, y + radius) + "]}";
    } else {
        intent.body = polygon_text(ring_text(dice_, x, y, radius, 4 + dice_.below(6)));
    }
    static constexpr std::array kOptions{"",           "?improve=none", "?improve=paper",
                                         "?lock=true", "?snap=0.01",    "?outside=reject"};
    if (dice_.chance(0.4)) intent.path += dice_.one_of(kOptions);
    intent.history_kind = "polygons";
    return intent;
}

Intent CrashClient::edit(const std::string& session) {
    Intent intent{.session = session, .method = "POST", .path = "/edits"};
    const int known = ledger_.polygons_of(session).second;
    const std::string polygon =
        "\"polygon\":\"p" + std::to_string(1 + dice_.below(known + 1)) + '"';
    static constexpr std::array kEdits{
        R"("operation":"set","elevation":2.5,"rim":0.02)",
        R"("operation":"set","elevation":1,"border":"new")",
        R"("operation":"offset","by":0.25,"rim":0.02)",
        R"("operation":"smooth","passes":2)",
    };
    intent.body = "{" + polygon + "," + dice_.one_of(kEdits) + "}";
    intent.history_kind = "edit";
    return intent;
}

/// Removals of polygons and locks, which take no key: of each session one client alone does them,
/// so that the history tells whether its own were made.
Intent CrashClient::owner_change(SteadyClient& server, const std::string& session) {
    Intent intent{.session = session};
    const auto [body, known] = ledger_.polygons_of(session);
    if (dice_.chance(0.5)) {
        intent.method = "DELETE";
        intent.path = "/polygons/p" + std::to_string(1 + dice_.below(known + 1));
        if (dice_.chance(0.5)) intent.path += "?cascade=true";
        intent.history_kind = "polygon_removed";
        intent.content_type.clear();
    } else {
        intent.method = dice_.chance(0.6) ? "PUT" : "DELETE";
        intent.path = "/locks";
        intent.body = body.empty() ? R"({"type":"LineString","coordinates":[[1,1],[2,2]]})" : body;
        intent.history_kind = "locks";
    }
    const std::string tag = server.ask("GET", "/v1/sessions/" + session).header("etag");
    intent.if_match = version_of_tag(tag);
    intent.headers.push_back("If-Match: " + (tag.empty() ? "\"none-1\"" : tag));
    return intent;
}

Intent CrashClient::question(const std::string& session) {
    static constexpr std::array kQuestions{"", "/polygons", "/history", "/locks", "/regions"};
    return {.kind = Intent::Kind::Question,
            .session = session,
            .method = "GET",
            .path = dice_.one_of(kQuestions),
            .content_type = ""};
}

/// Another session for a slot: a grid, or a copy of a session that stays.
Intent CrashClient::renew(int slot) {
    Intent intent{.kind = Intent::Kind::Create, .method = "POST", .path = "/v1/sessions"};
    intent.slot = slot;
    if (dice_.chance(0.4)) {
        const bool of_bundled = dice_.chance(0.1);
        intent.kind = Intent::Kind::Fork;
        intent.session = ledger_.in_slot(of_bundled ? Slots::kBundled : Slots::kStaying);
        intent.path = "/fork";
        intent.content_type.clear();
    } else {
        intent.body = grid_text(dice_, Slots::kPosts);
        if (dice_.chance(0.5)) {
            intent.method = "PUT";
            intent.path += "/own-" + new_key();
        }
    }
    return intent;
}

Intent CrashClient::next(SteadyClient& server) {
    const int slot = dice_.below(Slots::kCount);
    const std::string session = ledger_.in_slot(slot);
    Intent intent;
    if (session.empty()) {
        if (owns(slot))
            intent = renew(slot);
        else
            return question(ledger_.in_slot(Slots::kStaying));
    } else if (slot > Slots::kStaying && owns(slot) && dice_.chance(0.05)) {
        return {.kind = Intent::Kind::RemoveSession,
                .session = session,
                .method = "DELETE",
                .content_type = "",
                .slot = slot};
    } else if (owns(slot) && dice_.chance(0.2)) {
        return owner_change(server, session);
    } else {
        const double what = dice_.between(0, 1);
        const Extent& where = slot == Slots::kBundled ? Slots::kBundledExtent : Slots::kGridExtent;
        if (what < 0.5) {
            intent = polygons(session, where);
        } else if (what < 0.65) {
            intent = edit(session);
        } else if (what < 0.78) {
            intent = {.session = session, .method = "POST", .path = "/undo"};
            intent.history_kind = "undo";
            intent.content_type.clear();
        } else if (what < 0.88) {
            intent = {.session = session, .method = "POST", .path = "/redo"};
            intent.history_kind = "redo";
            intent.content_type.clear();
        } else {
            return question(session);
        }
        if (dice_.chance(0.3)) {
            const std::string tag = server.ask("GET", "/v1/sessions/" + session).header("etag");
            if (!tag.empty()) intent.headers.push_back("If-Match: " + tag);
        }
        if (dice_.chance(0.1))
            intent.headers.emplace_back("Accept: application/vnd.tinsmith.delta");
    }
    if (intent.method == "POST") {
        intent.key = new_key();
        intent.headers.push_back("Idempotency-Key: " + intent.key);
    }
    return intent;
}

/// Nothing: the server does not say.
std::optional<bool> CrashClient::was_made_before(SteadyClient& server, const Intent& intent) {
    const std::uint64_t version = intent.if_match + 1;
    const auto changes = history_of(server, intent.session);
    if (!changes) return std::nullopt;
    const auto found = changes->find(version);
    return found != changes->end() && found->second["change"] == intent.history_kind;
}

void CrashClient::note_session(const Intent& intent, const Answer& answer) {
    SessionRecord record;
    record.origin = intent;
    std::string where = answer.header("location");
    if (where.empty()) where = intent.path;  // of a PUT that was made before
    record.id = where.substr(where.rfind('/') + 1);
    record.first_version = std::max<std::uint64_t>(version_of_tag(answer.header("etag")), 1);
    if (intent.kind == Intent::Kind::Fork)
        record.polygons = ledger_.polygons_of(intent.session).second;
    std::string fault = ledger_.add_session(std::move(record));
    if (!fault.empty()) ledger_.add_fault(std::move(fault));
}

void CrashClient::note(const Intent& intent, const Answer& answer) {
    if (answer.header("idempotency-replayed") == "true") {
        ledger_.add_replay();
        if (intent.attempts == 1) ledger_.add_fault("a new key was known already: " + intent.key);
    }
    const bool is_fine = answer.status / 100 == 2;
    const bool is_of_the_work = std::ranges::find(kOfTheWork, answer.status) != kOfTheWork.end();
    if ((!is_fine && !is_of_the_work) || answer.body.find("key-reused") != std::string::npos) {
        ledger_.add_fault(intent.method + " " + intent.session + intent.path + " answered " +
                          std::to_string(answer.status) + ": " + answer.body.substr(0, 500));
    }
    switch (intent.kind) {
        case Intent::Kind::Question:
            break;
        case Intent::Kind::Change:
            if (is_fine) {
                std::string fault =
                    ledger_.add_change(intent, version_of_tag(answer.header("etag")));
                if (!fault.empty()) ledger_.add_fault(std::move(fault));
            }
            break;
        case Intent::Kind::Create:
        case Intent::Kind::Fork:
            if (is_fine || (intent.method == "PUT" && answer.status == 409 && intent.attempts > 1))
                note_session(intent, answer);
            break;
        case Intent::Kind::RemoveSession:
            ledger_.remove_session(intent.session, intent.slot);
            break;
    }
}

bool CrashClient::attempt(SteadyClient& server, Intent& intent) {
    const std::string target = intent.kind == Intent::Kind::Create
                                   ? intent.path
                                   : "/v1/sessions/" + intent.session + intent.path;
    std::vector<std::string> headers = intent.headers;
    if (!intent.content_type.empty()) headers.push_back("Content-Type: " + intent.content_type);
    if (!intent.key.empty() && intent.attempts == 0 && dice_.chance(0.04)) {
        ++intent.attempts;
        server.send_and_leave(intent.method, target, headers, intent.body);
    }
    ++intent.attempts;
    const Answer answer = server.try_once(intent.method, target, headers, intent.body);
    const bool is_under_way = answer.status == 409 && !answer.header("retry-after").empty();
    if (answer.status == 0 || answer.status == kUnavailable || is_under_way) return false;
    // Without a key the second attempt cannot tell its own first one from what others did.
    if (intent.kind == Intent::Kind::Change && intent.key.empty() && intent.attempts > 1 &&
        answer.status / 100 == 4) {
        const auto was_made = was_made_before(server, intent);
        if (!was_made) return false;
        if (*was_made) {
            std::string fault = ledger_.add_change(intent, intent.if_match + 1);
            if (!fault.empty()) ledger_.add_fault(std::move(fault));
            return true;
        }
    }
    note(intent, answer);
    return true;
}

void CrashClient::run(int port, const std::atomic<bool>& down) {
    SteadyClient server(port);
    while (!down) {
        if (!pending_) pending_ = next(server);
        if (attempt(server, *pending_)) {
            pending_.reset();
        } else if (!down) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

bool CrashClient::settle(int port) {
    SteadyClient server(port);
    for (int i = 0; pending_ && i < 1000; ++i) {
        if (attempt(server, *pending_))
            pending_.reset();
        else
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return !pending_;
}

}  // namespace tinsmith::e2e
