// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "core/mesh/tin_state.hpp"

namespace tinsmith::test {

/// Bits of all that a mesh is made of, member by member, without what lies unused between them.
class StateBits {
  public:
    explicit StateBits(const core::Tin& tin) {
        core::TinState::each(tin, [this](const auto&... member) { (take_member(member), ...); });
    }

    /// The members' number that differs first; -1: none.
    int difference(const StateBits& other) const {
        for (std::size_t i = 0; i < members_.size(); ++i)
            if (members_[i] != other.members_[i]) return static_cast<int>(i);
        return -1;
    }

  private:
    using State = core::TinState;

    template <typename T>
    void take_member(const T& member) {
        members_.emplace_back();
        take(member);
    }

    template <typename T>
    requires(std::is_arithmetic_v<T>) void take(T value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        members_.back().append(bytes, sizeof value);
    }
    template <typename T, typename A>
    void take(const std::vector<T, A>& list) {
        take(list.size());
        for (const T& each : list)
            take(each);
    }
    template <typename T, std::size_t N>
    void take(const std::array<T, N>& list) {
        for (const T& each : list)
            take(each);
    }
    void take(core::VertexId id) { take(id.value); }
    void take(core::TriangleId id) { take(id.value); }
    void take(core::FacetId id) { take(id.value); }
    void take(core::Side side) { take(side.code); }
    void take(const core::Point2& p) { take(p.x), take(p.y); }
    void take(const core::Point3& p) { take(p.plan()), take(p.z); }
    void take(const core::Bounds& box) { take(box.min), take(box.max); }
    void take(const core::Tin::Vertex& v) { take(v.point()), take(v.triangle); }
    void take(const core::Tin::Triangle& t) {
        take(t.vertices), take(t.twins), take(t.facet), take(t.marks);
    }
    void take(const core::ConstraintSplit& split) { take(split.a), take(split.b), take(split.p); }
    void take(const core::GoneEnd& end) { take(end.name), take(end.plan); }
    void take(const core::BoundaryIndex& index) {
        State::each_of_boundary(index, [this](const auto&... member) { (take(member), ...); });
    }
    void take(const State::BoundaryBox& box) {
        take(box.left), take(box.low), take(box.right), take(box.high);
    }
    void take(const State::BoundaryEntry& entry) {
        take(entry.vertex), take(entry.p), take(entry.q);
    }
    void take(const State::BoundaryChange& change) {
        take(change.entries), take(change.halvings), take(change.renamed), take(change.before);
    }
    void take(const State::BoundaryNode& node) {
        take(node.halves), take(node.by_y), take(node.entries);
    }

    std::vector<std::string> members_;
};

/// -1: the meshes are one in every bit of every member; otherwise which member differs first, in
/// the order of `TinState::each`.
inline int differing_member(const core::Tin& a, const core::Tin& b) {
    return StateBits(a).difference(StateBits(b));
}

}  // namespace tinsmith::test
