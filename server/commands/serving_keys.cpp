// SPDX-License-Identifier: Apache-2.0
#include "server/commands/serving_keys.hpp"

#include <array>
#include <iostream>
#include <optional>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>

#include "server/log.hpp"

namespace tinsmith::server {

namespace {

std::string joined(const KeyFaults& faults) {
    std::string text;
    for (const std::string& fault : faults)
        text += (text.empty() ? "" : "; ") + fault;
    return text;
}

}  // namespace

bool is_loopback(const std::string& host) {
    if (host == "localhost") return true;
    // By its numbers: 127.0.0.1.example.org is a name like any other.
    std::array<unsigned char, sizeof(in6_addr)> address{};
    if (::inet_pton(AF_INET, host.c_str(), address.data()) == 1) return address[0] == 127;
    return ::inet_pton(AF_INET6, host.c_str(), address.data()) == 1 &&
           address == std::array<unsigned char, sizeof(in6_addr)>{0, 0, 0, 0, 0, 0, 0, 0,
                                                                  0, 0, 0, 0, 0, 0, 0, 1};
}

ServingKeys::ServingKeys(const ServeConfig& config)
    : config_(config), file_(key_file_of(config.keys, config.data)) {}

std::string ServingKeys::start() {
    if (config_.first_key && !has_file())
        return "--first-key: there is no file to keep it in; say --data DIR or --keys FILE";
    if (has_file()) {
        // A file that was named has to be there, so that a slip of the pen opens nothing.
        const bool may_be_missing = config_.keys.empty() || config_.first_key;
        auto keys = read_key_file(file_, may_be_missing);
        if (const auto* faults = std::get_if<KeyFaults>(&keys)) return "--keys: " + joined(*faults);
        ring_.replace(std::get<Keys>(std::move(keys)));
        if (ring_.size() == 0 && config_.first_key) {
            if (std::string why = make_first_key(); !why.empty()) return "--first-key: " + why;
        }
    }
    const bool is_open = !is_loopback(config_.http.host);
    if (ring_.wants_keys()) {
        log_event(
            LogLevel::Info, "keys",
            "/v1 and /metrics want an API key; " + std::to_string(ring_.size()) + " are known",
            {{"keys", ring_.size()}});
    } else if (is_open && !config_.insecure) {
        return "--host " + config_.http.host +
               " is beyond this machine, and there is no API key: everyone who reaches the port "
               "could read, change and delete every session. Make a key with \"tinsmith key add "
               "NAME " +
               (has_file() ? "--keys " + file_ : "--keys FILE\" and serve with \"--keys FILE") +
               "\", or have one made with --first-key, or say --insecure if everyone may.";
    } else if (is_open) {
        log_event(LogLevel::Warning, "exposed",
                  "LISTENING BEYOND THIS MACHINE (" + config_.http.host +
                      ") WITHOUT KEYS, as --insecure says: everyone who reaches the port can read, "
                      "change and delete every session. Put a proxy with access control in front.");
    }
    return {};
}

std::string ServingKeys::make_first_key() {
    const std::string key = new_key();
    const KeyFaults faults =
        change_key_file(file_, [&key](Keys& keys) -> std::optional<std::string> {
            if (!keys.empty()) return "another process made one just now: start again";
            keys.push_back({"first", new_key_id(), hash_of_key(key), time_of_making(), {}});
            return std::nullopt;
        });
    if (!faults.empty()) return joined(faults);
    auto keys = read_key_file(file_, false);
    if (const auto* wrong = std::get_if<KeyFaults>(&keys)) return joined(*wrong);
    ring_.replace(std::get<Keys>(std::move(keys)));
    log_event(LogLevel::Info, "first_key", "a first API key was made; standard output has it",
              {{"name", "first"}, {"file", file_}});
    // Not through the log: what collects logs keeps them.
    std::cout << "This server's first API key, told this once; " << file_
              << " has its SHA-256 and not the key:\nTINSMITH_KEY=" << key << std::endl;
    return {};
}

void ServingKeys::read_again() {
    auto keys = read_key_file(file_, config_.keys.empty() && !ring_.wants_keys());
    if (const auto* faults = std::get_if<KeyFaults>(&keys)) {
        log_event(LogLevel::Error, "keys_refused",
                  "the API keys of before stay in force: " + joined(*faults));
        return;
    }
    ring_.replace(std::get<Keys>(std::move(keys)));
    log_event(LogLevel::Info, "keys",
              "read again: " + std::to_string(ring_.size()) + " API keys are known",
              {{"keys", ring_.size()}});
}

}  // namespace tinsmith::server
