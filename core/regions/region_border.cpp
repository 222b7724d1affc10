// SPDX-License-Identifier: Apache-2.0
#include "core/regions/region_border.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/mesh/triangle_map.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {
namespace {

using Ring = std::vector<VertexId>;

/// Where a vertex is. Beside a hole two vertices may be in one place, each of a fan of its own.
using PlanKey = std::array<std::uint64_t, 2>;

struct PlanHash {
    /// Where something lies in memory, which nobody knows who sends a mesh: places chosen so that
    /// they fall together do so for one key only.
    std::uint64_t key;

    std::size_t operator()(const PlanKey& place) const {
        std::uint64_t hash = (place[0] ^ key) * 0x9e3779b97f4a7c15ULL;
        hash = (hash ^ hash >> 32 ^ place[1]) * 0x9e3779b97f4a7c15ULL;
        return static_cast<std::size_t>(hash ^ hash >> 32);
    }
};

/// By place: where in the open ring it is.
using RingPlaces = std::unordered_map<PlanKey, std::size_t, PlanHash>;

/// A vertex that is lowest of all turns outwards, and no simple ring is straight there.
bool is_counter_clockwise(const Tin& tin, const Ring& ring) {
    std::size_t low = 0;
    const auto before = [&](VertexId a, VertexId b) {
        const Point2 p = tin.plan(a), q = tin.plan(b);
        return p.x < q.x || (p.x == q.x && p.y < q.y);
    };
    for (std::size_t i = 1; i < ring.size(); ++i) {
        if (before(ring[i], ring[low])) low = i;
    }
    return orientation(tin.plan(ring[(low + ring.size() - 1) % ring.size()]), tin.plan(ring[low]),
                       tin.plan(ring[(low + 1) % ring.size()])) == Orientation::CounterClockwise;
}

class BorderFinder {
  public:
    BorderFinder(const Tin& tin, std::span<const TriangleId> triangles)
        : tin_(tin), triangles_(triangles), part_(tin.triangle_count()) {}

    std::vector<BorderedPart> find() {
        label_parts();
        for (const TriangleId t : triangles_) {
            for (unsigned i = 0; i < 3; ++i) {
                const Side side(t, i);
                if (is_border(side) && !walked_.contains(side.code)) walk(side);
            }
        }
        return std::move(parts_);
    }

  private:
    /// Part 0 is what is not in the set.
    void label_parts() {
        for (const TriangleId t : triangles_)
            part_.at(t) = kUnlabelled;
        std::vector<TriangleId> pending;
        for (const TriangleId first : triangles_) {
            if (part_.value(first) != kUnlabelled) continue;
            parts_.emplace_back();
            const auto label = static_cast<std::uint32_t>(parts_.size());
            part_.at(first) = label;
            pending.push_back(first);
            // Ends: each triangle is labelled once.
            while (!pending.empty()) {
                const TriangleId t = pending.back();
                pending.pop_back();
                for (unsigned i = 0; i < 3; ++i) {
                    const Side twin = tin_.twin(Side(t, i));
                    if (!twin.valid() || part_.value(twin.triangle()) != kUnlabelled) continue;
                    part_.at(twin.triangle()) = label;
                    pending.push_back(twin.triangle());
                }
            }
        }
    }

    bool is_border(Side side) const {
        const Side twin = tin_.twin(side);
        return !twin.valid() || part_.value(twin.triangle()) == 0;
    }

    /// The border's side that follows, around the fan of the set's triangles at its destination:
    ///
    ///          \  |  /          side comes up to v, the set on its left;
    ///       next\ | /           next leaves v where the fan ends
    ///            \|/
    ///             v
    ///             | side
    Side after(Side side) const {
        Side next = side.next();
        // Ends: the fan is part of the triangles around v, of which `side` is not inside.
        while (!is_border(next)) {
            const Side twin = tin_.twin(next);
            next = twin.next();
        }
        return next;
    }

    PlanKey place_of(VertexId v) const {
        const Point2 p = tin_.plan(v);
        // Both noughts are one.
        return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0)};
    }

    /// Follows the border around and parts it wherever it comes to a place again.
    void walk(Side first) {
        BorderedPart& part = parts_[part_.value(first.triangle()) - 1];
        Ring open;
        RingPlaces places(16, PlanHash{reinterpret_cast<std::uintptr_t>(parts_.data())});
        Side side = first;
        do {
            walked_.insert(side.code);
            const VertexId v = tin_.origin(side);
            const PlanKey place = place_of(v);
            if (const auto found = places.find(place); found != places.end())
                close(part, open, places, found->second);
            places.emplace(place, open.size());
            open.push_back(v);
            side = after(side);
        } while (side != first);
        close(part, open, places, 0);
    }

    void close(BorderedPart& part, Ring& open, RingPlaces& places, std::size_t from) {
        const auto begin = open.begin() + static_cast<std::ptrdiff_t>(from);
        Ring ring(begin, open.end());
        for (const VertexId v : ring)
            places.erase(place_of(v));
        open.erase(begin, open.end());
        if (ring.size() < 3) return;  // out along a slit and back
        if (is_counter_clockwise(tin_, ring)) {
            part.outer = std::move(ring);
        } else {
            part.holes.push_back(std::move(ring));
        }
    }

    static constexpr std::uint32_t kUnlabelled = UINT32_MAX;
    const Tin& tin_;
    std::span<const TriangleId> triangles_;
    TriangleMap<std::uint32_t> part_;
    std::unordered_set<std::uint32_t> walked_;
    std::vector<BorderedPart> parts_;
};

}  // namespace

std::vector<BorderedPart> border_of(const Tin& tin, std::span<const TriangleId> triangles) {
    return BorderFinder(tin, triangles).find();
}

}  // namespace tinsmith::core
