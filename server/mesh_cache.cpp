// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_cache.hpp"

#include <iterator>
#include <new>
#include <utility>

namespace tinsmith::server {

namespace {

std::size_t bytes_of(const MeshKey& key, const EncodedMesh& mesh) {
    std::size_t bytes = sizeof(EncodedMesh) + 2 * (sizeof(MeshKey) + key.representation.size());
    for (const auto& [name, value] : mesh.response.headers)
        bytes += sizeof(NameValue) + name.size() + value.size();
    return bytes + mesh.response.body.size();
}

}  // namespace

MeshCache::Found MeshCache::get(const MeshKey& key, const Encode& encode) {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (auto found = find(key)) {
            ++counts_.hits;
            return found;
        }
        auto& place = under_way_[key];
        if (!place) {
            place = std::make_shared<Work>();
            break;
        }
        const std::shared_ptr<Work> work = place;
        finished_.wait(lock, [&work] { return work->done; });
        if (work->mesh) {
            ++counts_.hits;
            return work->mesh;
        }
    }
    ++counts_.encodings;
    lock.unlock();
    Found mesh;
    try {
        mesh = encode();
    } catch (...) {
        finish(key, nullptr);
        throw;
    }
    finish(key, mesh);
    return mesh;
}

/// Requires: the lock.
MeshCache::Found MeshCache::find(const MeshKey& key) {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->mesh;
}

void MeshCache::finish(const MeshKey& key, const Found& mesh) {
    const std::lock_guard lock(mutex_);
    const auto work = under_way_.find(key);
    work->second->done = true;
    work->second->mesh = mesh;
    under_way_.erase(work);
    finished_.notify_all();
    if (!mesh) return;
    try {
        keep({key.birth, mesh->version, key.representation}, mesh);
    } catch (const std::bad_alloc&) {
        // Not kept, then; it can be sent all the same.
    }
}

/// Requires: the lock.
void MeshCache::keep(MeshKey key, const Found& mesh) {
    const std::size_t bytes = bytes_of(key, *mesh);
    if (bytes > budget_ || by_key_.contains(key)) return;
    while (counts_.bytes + bytes > budget_)
        drop(std::prev(entries_.end()));
    entries_.push_front({key, mesh, bytes});
    try {
        by_key_.emplace(std::move(key), entries_.begin());
    } catch (...) {
        entries_.pop_front();
        throw;
    }
    counts_.bytes += bytes;
}

/// Requires: the lock.
void MeshCache::drop(Entries::iterator entry) {
    counts_.bytes -= entry->bytes;
    by_key_.erase(entry->key);
    entries_.erase(entry);
}

void MeshCache::forget(const std::string& birth) {
    const std::lock_guard lock(mutex_);
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        const auto next = std::next(entry);
        if (entry->key.birth == birth) drop(entry);
        entry = next;
    }
}

MeshCache::Counts MeshCache::counts() const {
    const std::lock_guard lock(mutex_);
    Counts counts = counts_;
    counts.entries = entries_.size();
    return counts;
}

}  // namespace tinsmith::server
