// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/routes/restored_answers.hpp"
#include "server/session_keeper.hpp"
#include "tests/unit/server/handlers.hpp"
#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {

/// One life of a server over a folder.
class Life {
  public:
    Life(const JournalOptions& options, const Limits& limits, TailBounds tail = {})
        : services_(limits, {}, open(options, limits, tail)) {
        keeper_.emplace(services_);
        store_answers(services_);
        damaged_ = services_.sessions.take_up();
        restore_answers(services_);
        services_.sessions.load_all([] { return true; });
        router_.emplace(make_routes(services_));
    }

    Response ask(const std::string& method, const std::string& target,
                 std::vector<NameValue> headers = {}, const std::string& body = {}) {
        if (!body.empty()) headers.emplace_back("content-type", "application/json");
        return server::ask(*router_, services_, method, target, std::move(headers), body,
                           [this](Request& request) {
                               request.asker = asker;
                               return std::optional<Response>();
                           });
    }
    Response make(const std::string& id) { return ask("PUT", "/v1/sessions/" + id, {}, kSquare); }
    Response cut(const std::string& id, double at, std::vector<NameValue> headers = {}) {
        json ring = json::array();
        for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}, {0, 0}})
            ring.push_back({at + x, at + y});
        return ask("POST", "/v1/sessions/" + id + "/polygons", std::move(headers),
                   json{{"type", "Polygon"}, {"coordinates", {ring}}}.dump());
    }
    std::string get(const std::string& path) {
        const Response response = ask("GET", "/v1/sessions/" + path);
        EXPECT_EQ(response.status, 200) << path << " " << response.body;
        return response.body;
    }
    json view(const std::string& id) { return json::parse(get(id)); }
    /// Of all sessions, what does not depend on how much of them is in memory.
    json list() {
        json sessions = json::parse(ask("GET", "/v1/sessions").body)["sessions"];
        for (json& session : sessions)
            session.erase("memory_bytes");
        return sessions;
    }
    std::size_t tail(const std::string& birth) {
        return std::get<0>(services_.vault->journal().read(birth)).tail.size();
    }

    static std::string header_of(const Response& response, const std::string& name) {
        for (const auto& [key, value] : response.headers)
            if (key == name) return value;
        return {};
    }

    Asker asker;  ///< of what is asked from now on

    Services& services() { return services_; }
    SessionKeeper& keeper() { return *keeper_; }
    const std::vector<std::string>& damaged() const { return damaged_; }

  private:
    static std::unique_ptr<SessionVault> open(const JournalOptions& options, const Limits& limits,
                                              TailBounds tail) {
        auto vault =
            SessionVault::open(options, {limits.max_history, limits.max_history_bytes}, tail);
        if (const auto* why = std::get_if<std::string>(&vault)) ADD_FAILURE() << *why;
        return std::get<0>(std::move(vault));
    }

    Services services_;
    std::optional<SessionKeeper> keeper_;
    std::optional<Router> router_;
    std::vector<std::string> damaged_;
};

class StoredSessions : public JournalFolder {
  protected:
    /// The old life ends first.
    Life& restart(TailBounds tail = {}) {
        life_.reset();
        return life_.emplace(options_, limits_, tail);
    }
    void end() { life_.reset(); }
    Life& life() { return life_ ? *life_ : restart(); }

    void TearDown() override {
        end();
        JournalFolder::TearDown();
    }

    Limits limits_;

  private:
    std::optional<Life> life_;
};

}  // namespace tinsmith::server
