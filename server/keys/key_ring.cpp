// SPDX-License-Identifier: Apache-2.0
#include "server/keys/key_ring.hpp"

#include <utility>

#include "server/digest.hpp"

namespace tinsmith::server {

KeyRing::KeyRing(Keys keys) {
    replace(std::move(keys));
}

void KeyRing::replace(Keys keys) {
    auto made = std::make_shared<const Keys>(std::move(keys));
    const std::lock_guard lock(mutex_);
    wants_keys_ = wants_keys_ || !made->empty();
    keys_.swap(made);
}

std::shared_ptr<const Keys> KeyRing::keys() const {
    const std::lock_guard lock(mutex_);
    return keys_;
}

bool KeyRing::wants_keys() const {
    const std::lock_guard lock(mutex_);
    return wants_keys_;
}

std::size_t KeyRing::size() const {
    return keys()->size();
}

std::optional<Asker> KeyRing::find(std::string_view key) const {
    const auto all = keys();
    const std::string hash = hash_of_key(key);
    const ApiKey* found = nullptr;
    for (const ApiKey& one : *all)  // to the end, wherever it is found
        if (same_in_constant_time(one.hash, hash)) found = &one;
    if (found == nullptr) return std::nullopt;
    return Asker{found->id, found->name, found->quotas};
}

}  // namespace tinsmith::server
