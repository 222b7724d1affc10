// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <optional>
#include <utility>

#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/keys/key_file.hpp"

namespace tinsmith::server {

namespace {

using Change = std::optional<std::string>;

constexpr const char* kNameLaw =
    " is not 1 to 64 letters, digits, dots, dashes and underscores with a letter or digit in front";
constexpr const char* kHangup = "A server that runs reads the file again on SIGHUP.\n";

Keys::iterator find(Keys& keys, const std::string& name) {
    return std::ranges::find(keys, name, &ApiKey::name);
}

std::string no_such_key(const std::string& name) {
    return "there is no key \"" + name + "\"; \"tinsmith key list\" says which there are";
}

/// Whether it was done; complains where it was not.
template <typename Make>
bool change(const std::string& file, Make make) {
    const KeyFaults faults = change_key_file(file, make);
    for (const std::string& fault : faults)
        complain(fault);
    return faults.empty();
}

void print(const std::string& key, const std::string& name) {
    // The key alone on standard output, for scripts.
    std::cerr << "The API key of " << name
              << ", told this once: the file has its SHA-256 and not the key. " << kHangup;
    std::cout << key << std::endl;
}

int add(const KeyConfig& config, const std::string& file) {
    const bool is_name = is_key_name(config.name);
    if (!is_name || (!config.id.empty() && !is_key_name(config.id))) {
        complain("\"" + (is_name ? config.id : config.name) + "\"" + kNameLaw);
        return kExitRefused;
    }
    const std::string key = new_key();
    const bool is_done = change(file, [&](Keys& keys) -> Change {
        if (find(keys, config.name) != keys.end())
            return "there is a key \"" + config.name +
                   "\" already: \"tinsmith key renew\" makes it a new one";
        const std::string id = config.id.empty() ? new_key_id() : config.id;
        if (std::ranges::find(keys, id, &ApiKey::id) != keys.end())
            return "another key has the id " + id;
        keys.push_back({config.name, id, hash_of_key(key), time_of_making(), config.quotas});
        return std::nullopt;
    });
    if (!is_done) return kExitRefused;
    print(key, config.name);
    return kExitOk;
}

int renew(const KeyConfig& config, const std::string& file) {
    const std::string key = new_key();
    const bool is_done = change(file, [&](Keys& keys) -> Change {
        const auto old = find(keys, config.name);
        if (old == keys.end()) return no_such_key(config.name);
        old->hash = hash_of_key(key);
        old->made = time_of_making();
        return std::nullopt;
    });
    if (!is_done) return kExitRefused;
    print(key, config.name);
    return kExitOk;
}

int remove(const KeyConfig& config, const std::string& file) {
    std::string id;
    const bool is_done = change(file, [&](Keys& keys) -> Change {
        const auto old = find(keys, config.name);
        if (old == keys.end()) return no_such_key(config.name);
        id = old->id;
        keys.erase(old);
        return std::nullopt;
    });
    if (!is_done) return kExitRefused;
    std::cout << "Removed " << config.name << ". What it made stays stored under the id " << id
              << ", for no key to see; \"tinsmith key add NAME --id " << id
              << "\" gives it to a new key. " << kHangup;
    return kExitOk;
}

int list(const std::string& file) {
    const auto read = read_key_file(file, false);
    if (const auto* faults = std::get_if<KeyFaults>(&read)) {
        for (const std::string& fault : *faults)
            complain(fault);
        return kExitRefused;
    }
    for (const ApiKey& key : std::get<Keys>(read)) {
        std::cout << key.name << '\t' << key.id << '\t' << key.made;
        for (const auto& [name, value] : named_quotas(key.quotas))
            if (value) std::cout << '\t' << name << '=' << quota_text(*value);
        std::cout << '\n';
    }
    return kExitOk;
}

}  // namespace

int run_key(const KeyConfig& config) {
    const std::string file = key_file_of(config.keys, config.data);
    if (file.empty()) {
        complain("which file of keys? Say --keys FILE, or --data DIR of the server");
        return kExitUsage;
    }
    switch (config.action) {
        case KeyConfig::Action::Add:
            return add(config, file);
        case KeyConfig::Action::Renew:
            return renew(config, file);
        case KeyConfig::Action::Remove:
            return remove(config, file);
        case KeyConfig::Action::List:
            break;
    }
    return list(file);
}

}  // namespace tinsmith::server
