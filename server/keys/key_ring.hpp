// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "server/keys/key_file.hpp"

namespace tinsmith::server {

/// The keys in force. From any thread.
///
/// Laws: once keys have been wanted they are wanted until the process ends, whatever is put in:
/// emptying a file opens nothing. How long a search takes says nothing about how near a wrong key
/// comes to a right one: hashes are compared, all of them, each in constant time.
class KeyRing {
  public:
    explicit KeyRing(Keys keys = {});

    /// In place of those that there are.
    void replace(Keys keys);

    /// Whether whoever asks has to have one.
    bool wants_keys() const;
    std::size_t size() const;

    /// Whose it is; nothing: nobody's.
    std::optional<Asker> find(std::string_view key) const;

  private:
    std::shared_ptr<const Keys> keys() const;

    mutable std::mutex mutex_;  ///< guards the next two, and is never held for long
    std::shared_ptr<const Keys> keys_;
    bool wants_keys_ = false;
};

}  // namespace tinsmith::server
