// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_digest.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "server/digest.hpp"

namespace tinsmith::server {

namespace {

/// Slots as bytes, one after the other.
class SlotBytes {
  public:
    explicit SlotBytes(const core::Tin& tin) : tin_(tin) {}

    void number(std::uint64_t value) { append(&value, sizeof value); }
    void vertices(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            vertex({static_cast<std::uint32_t>(i)});
    }
    void triangles(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            triangle({static_cast<std::uint32_t>(i)});
    }
    /// Slots that are gone by now are passed over.
    void vertex(core::VertexId id) {
        if (id.index() >= tin_.vertex_count()) return;
        const core::Tin::Vertex& slot = tin_.vertex(id);  // its padding is nobody's
        const std::array<double, 3> place{slot.x, slot.y, slot.z};
        append(&id, sizeof id);
        append(place.data(), sizeof place);
        append(&slot.triangle, sizeof slot.triangle);
    }
    void triangle(core::TriangleId id) {
        if (id.index() >= tin_.triangle_count()) return;
        append(&id, sizeof id);
        append(&tin_.triangle(id), sizeof(core::Tin::Triangle));
    }
    void written(const Applied& applied) {
        for (const core::UndoRecord& record : applied.undo) {
            for (const auto& [id, before] : record.vertices)
                vertex(id);
            for (const auto& [id, before] : record.triangles)
                triangle(id);
            vertices(record.vertex_count, tin_.vertex_count());
            triangles(record.triangle_count, tin_.triangle_count());
        }
    }
    std::string_view bytes() const { return bytes_; }
    void clear() { bytes_.clear(); }

  private:
    void append(const void* from, std::size_t count) {
        bytes_.append(static_cast<const char*>(from), count);
    }

    const core::Tin& tin_;
    std::string bytes_;
};

std::string digest_of(const std::string& before, const SlotBytes& bytes) {
    const std::array<std::string_view, 2> parts{before, bytes.bytes()};
    return sha256_of(parts);
}

}  // namespace

std::string whole_digest(const core::Tin& tin) {
    constexpr std::size_t kAtATime = 100'000;
    SlotBytes bytes(tin);
    bytes.number(tin.vertex_count());
    bytes.number(tin.triangle_count());
    std::string digest = digest_of({}, bytes);
    for (std::size_t begin = 0; begin < tin.vertex_count(); begin += kAtATime) {
        bytes.clear();
        bytes.vertices(begin, std::min(begin + kAtATime, tin.vertex_count()));
        digest = digest_of(digest, bytes);
    }
    for (std::size_t begin = 0; begin < tin.triangle_count(); begin += kAtATime) {
        bytes.clear();
        bytes.triangles(begin, std::min(begin + kAtATime, tin.triangle_count()));
        digest = digest_of(digest, bytes);
    }
    return digest;
}

std::string next_digest(const std::string& before, std::uint64_t version, const core::Tin& tin,
                        std::span<const AppliedPtr> taken, std::span<const AppliedPtr> done) {
    SlotBytes bytes(tin);
    bytes.number(version);
    bytes.number(tin.vertex_count());
    bytes.number(tin.triangle_count());
    bytes.number(tin.next_facet());
    for (const AppliedPtr& applied : taken)
        bytes.written(*applied);
    for (const AppliedPtr& applied : done)
        bytes.written(*applied);
    return digest_of(before, bytes);
}

}  // namespace tinsmith::server
