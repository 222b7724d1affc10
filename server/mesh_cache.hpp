// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// What one encoding of a mesh depends on, whole.
struct MeshKey {
    std::string birth;  ///< of the session
    std::uint64_t version = 0;
    std::string representation;  ///< format, options and coding

    auto operator<=>(const MeshKey&) const = default;
};

/// A mesh as it goes out: body, type and the headers that say what rounding did. Nothing in it
/// belongs to one request.
struct EncodedMesh {
    std::uint64_t version = 0;
    Response response;
};

/// Encoded meshes within a budget of bytes, the one asked for longest ago going first.
///
/// Laws: of several who ask for one key at the same time one encodes, the others wait for it and
/// hold no lock meanwhile; nothing is kept beyond the budget, and nothing that was refused; what a
/// caller holds lives on when it is dropped here.
/// An encoding of a later version than asked for (an edit came in between) is filed under its own.
/// Cost beside encoding: a map search.
class MeshCache {
  public:
    using Found = std::shared_ptr<const EncodedMesh>;
    /// Null: it cannot be encoded. Those who wait then try for themselves.
    using Encode = std::function<Found()>;

    struct Counts {
        std::uint64_t encodings = 0;  ///< calls of `encode`, fruitless ones included
        std::uint64_t hits = 0;       ///< answers that needed none
        std::size_t entries = 0;
        std::size_t bytes = 0;
    };

    explicit MeshCache(std::size_t budget) : budget_(budget) {}

    /// What is kept under the key, or what `encode` makes. Throws what `encode` throws.
    Found get(const MeshKey& key, const Encode& encode);

    /// Drops all of one session.
    void forget(const std::string& birth);

    Counts counts() const;

  private:
    struct Entry {
        MeshKey key;
        Found mesh;
        std::size_t bytes = 0;
    };
    struct Work {
        bool done = false;
        Found mesh;
    };
    using Entries = std::list<Entry>;

    Found find(const MeshKey& key);
    void keep(MeshKey key, const Found& mesh);
    void drop(Entries::iterator entry);
    void finish(const MeshKey& key, const Found& mesh);

    const std::size_t budget_;
    mutable std::mutex mutex_;  ///< never held while something is encoded
    std::condition_variable finished_;
    Entries entries_;  ///< the one asked for last is in front
    std::map<MeshKey, Entries::iterator> by_key_;
    std::map<MeshKey, std::shared_ptr<Work>> under_way_;
    Counts counts_;
};

}  // namespace tinsmith::server
