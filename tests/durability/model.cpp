// SPDX-License-Identifier: Apache-2.0
#include "tests/durability/model.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace tinsmith::e2e {

namespace {

std::string path_of(const std::string& id) {
    return "/v1/sessions/" + id;
}

/// The text with one name for another.
std::string renamed(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// Some of the text around a place, to be read by people.
std::string around(const std::string& text, std::size_t place) {
    std::string part =
        text.substr(std::min(place - std::min<std::size_t>(place, 60), text.size()), 120);
    for (char& c : part)
        if (c < ' ' || c > '~') c = '.';
    return '"' + part + '"';
}

std::string first_difference(const std::string& one, const std::string& other) {
    const auto length = static_cast<std::ptrdiff_t>(std::min(one.size(), other.size()));
    const auto at = std::mismatch(one.begin(), one.begin() + length, other.begin()).first;
    const auto place = static_cast<std::size_t>(at - one.begin());
    return std::to_string(one.size()) + " and " + std::to_string(other.size()) + " bytes, at " +
           std::to_string(place) + ": " + around(one, place) + " and " + around(other, place);
}

}  // namespace

Answer make_bundled(SteadyClient& server, const std::string& id) {
    static const std::string kTerrain = content_of(TINSMITH_SOURCE_DIR "/tests/data/jacksboro.tif");
    return server.ask("PUT", path_of(id), {"Content-Type: image/tiff"}, kTerrain);
}

std::string Model::make(const SessionRecord& session) {
    const Intent& origin = session.origin;
    Answer made;
    if (origin.kind == Intent::Kind::Fork) {
        made = client_.ask("POST", path_of(twins_[origin.session].id) + "/fork");
    } else if (origin.body.empty()) {
        made = make_bundled(client_, session.id);
    } else {
        made = client_.ask("POST", "/v1/sessions", {"Content-Type: application/json"}, origin.body);
    }
    const std::string where = made.header("location");
    Twin twin{where.substr(where.rfind('/') + 1), version_of_tag(made.header("etag"))};
    if (made.status != 201 || twin.version != session.first_version)
        return "the model of " + session.id + " has version " + std::to_string(twin.version) +
               ", not " + std::to_string(session.first_version) + ": " + made.body + "\n";
    twins_[session.id] = twin;
    return {};
}

std::string Model::do_changes(const SessionRecord& session, std::uint64_t up_to) {
    Twin& twin = twins_[session.id];
    for (; twin.version < up_to; ++twin.version) {
        const auto change = session.changes.find(twin.version + 1);
        const std::string what =
            "version " + std::to_string(twin.version + 1) + " of " + session.id;
        if (change == session.changes.end()) return what + " was asked for by nobody\n";
        const Intent& intent = change->second;
        std::vector<std::string> headers;
        if (!intent.content_type.empty()) headers.push_back("Content-Type: " + intent.content_type);
        const Answer answer =
            client_.ask(intent.method, path_of(twin.id) + intent.path, headers, intent.body);
        if (answer.status != 200 || version_of_tag(answer.header("etag")) != twin.version + 1)
            return what + " is answered otherwise by the model: " + answer.body + "\n";
    }
    return {};
}

std::string Model::follow(const std::map<std::string, SessionRecord>& sessions) {
    for (auto twin = twins_.begin(); twin != twins_.end();) {
        if (sessions.contains(twin->first)) {
            ++twin;
            continue;
        }
        client_.ask("DELETE", path_of(twin->second.id));
        twin = twins_.erase(twin);
    }
    // Copies are made when their source is where it was then.
    std::vector<const SessionRecord*> forks;
    std::string wrong;
    for (const auto& [id, session] : sessions) {
        if (twins_.contains(id)) continue;
        if (session.origin.kind == Intent::Kind::Fork)
            forks.push_back(&session);
        else
            wrong += make(session);
    }
    std::ranges::sort(forks, {}, &SessionRecord::first_version);
    for (const SessionRecord* fork : forks) {
        wrong += do_changes(sessions.at(fork->origin.session), fork->first_version);
        wrong += make(*fork);
    }
    for (const auto& [id, session] : sessions) {
        const std::uint64_t last =
            session.changes.empty() ? session.first_version : session.changes.rbegin()->first;
        if (twins_.contains(id)) wrong += do_changes(session, last);
    }
    return wrong;
}

std::string Model::difference(SteadyClient& other, const SessionRecord& session) {
    const std::string& twin = twins_[session.id].id;
    struct Question {
        std::string path;
        std::string accept;
    };
    // The first is all of the mesh, in doubles and in the order of slots.
    std::vector<Question> questions{{"/mesh?since=0", "application/vnd.tinsmith.delta"},
                                    {"/history?limit=1000", "application/json"},
                                    {"/locks?limit=1000", "application/json"},
                                    {"/polygons?limit=1000", "application/json"}};
    const bool is_small = !session.origin.body.empty();
    if (is_small) questions.push_back({"/mesh.json", "application/json"});
    std::string wrong;
    for (const auto& [path, accept] : questions) {
        const std::vector<std::string> headers{"Accept: " + accept};
        const Answer theirs = other.ask("GET", path_of(session.id) + path, headers);
        const Answer ours = client_.ask("GET", path_of(twin) + path, headers);
        const std::string told = renamed(theirs.body, session.id, twin);
        if (theirs.status != 200 || ours.status != 200) {
            wrong += session.id + path + " is answered " + std::to_string(theirs.status) + ": " +
                     theirs.body.substr(0, 300) + "\n";
        } else if (told != ours.body) {
            wrong += session.id + path + " differs: " + first_difference(told, ours.body) + "\n";
        }
    }
    return wrong;
}

}  // namespace tinsmith::e2e
