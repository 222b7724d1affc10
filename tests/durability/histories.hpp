// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/durability/steady_client.hpp"

namespace tinsmith::e2e {

using History = std::map<std::uint64_t, nlohmann::json>;

/// What the server tells of every version that it keeps; empty where there is no such session.
/// Nothing: it gave no answer.
inline std::optional<History> history_of(SteadyClient& server, const std::string& session) {
    History history;
    std::string target = "/v1/sessions/" + session + "/history?limit=1000";
    while (!target.empty()) {
        const Answer answer = server.ask("GET", target);
        if (answer.status == 404) return History();
        if (answer.status != 200) return std::nullopt;
        const auto page = nlohmann::json::parse(answer.body, nullptr, false);
        for (const auto& change : page.value("changes", nlohmann::json()))
            history.try_emplace(change.value("version", std::uint64_t{0}), change);
        const std::string link = answer.header("link");
        const std::size_t end = link.find(">; rel=\"next\"");
        target = end == std::string::npos ? "" : link.substr(1, end - 1);
    }
    return history;
}

}  // namespace tinsmith::e2e
