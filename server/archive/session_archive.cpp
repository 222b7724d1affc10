// SPDX-License-Identifier: Apache-2.0
#include "server/archive/session_archive.hpp"

#include <utility>

#include "core/mesh/tin_state.hpp"
#include "server/archive/server_parts.hpp"

namespace tinsmith::server {

namespace {

template <typename T>
std::string packed(const T& value) {
    Packer pack;
    pack(value);
    return pack.take();
}

template <typename T>
std::optional<T> unpacked(std::string_view bytes) {
    T value;
    Unpacker unpack(bytes);
    unpack(value);
    if (!unpack.done()) return std::nullopt;
    return value;
}

}  // namespace

std::string pack(const SessionParts& parts) {
    const auto& [facts, tin, history, next_polygon, digest] = parts;
    Packer pack;
    pack.reserve(tin.memory_bytes() + history.memory_bytes());
    pack(facts, tin, history, next_polygon, digest);
    return pack.take();
}

std::optional<SessionImage> unpack_image(std::string_view bytes, HistoryLimits limits) {
    SessionImage image{{}, core::TinState::blank(), History(limits, 0, 0), 1, {}};
    Unpacker unpack(bytes);
    unpack(image.facts, image.tin, image.history, image.next_polygon, image.digest);
    if (!unpack.done()) return std::nullopt;
    core::TinState::make_room(image.tin);
    return image;
}

std::string pack(const ChangeAsked& asked) {
    return packed(asked);
}
std::optional<ChangeAsked> unpack_asked(std::string_view bytes) {
    return unpacked<ChangeAsked>(bytes);
}

std::string pack(const SessionFacts& facts) {
    return packed(facts);
}
std::optional<SessionFacts> unpack_facts(std::string_view bytes) {
    return unpacked<SessionFacts>(bytes);
}

std::string pack(const SessionFacts& facts, const std::string& owner) {
    Packer pack;
    pack(facts);
    if (!owner.empty()) pack(owner);
    return pack.take();
}
std::optional<SessionFacts> unpack_facts(std::string_view bytes, std::string& owner) {
    owner.clear();
    if (auto facts = unpack_facts(bytes)) return facts;
    SessionFacts facts;
    Unpacker unpack(bytes);
    unpack(facts, owner);
    if (unpack.done() && !owner.empty()) return facts;
    owner.clear();
    return std::nullopt;
}

std::string pack(const SessionCounts& counts) {
    return packed(counts);
}
std::optional<SessionCounts> unpack_counts(std::string_view bytes) {
    return unpacked<SessionCounts>(bytes);
}

}  // namespace tinsmith::server
