// SPDX-License-Identifier: Apache-2.0
// A session's polygons by pages.
#include <charconv>

#include "core/regions/constraint_history.hpp"
#include "server/draping.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

namespace {

/// 7 of "p7".
std::uint64_t number_of(const Polygon& polygon) {
    std::uint64_t number = 0;
    std::from_chars(polygon.id().data() + 1, polygon.id().data() + polygon.id().size(), number);
    return number;
}

}  // namespace

DrapedCopy Session::draped_after(std::uint64_t number, std::size_t limit) const {
    const auto lock = lock_to_read();
    DrapedCopy copy{{}, version()};
    const std::vector<Polygon> polygons = history_.polygons();
    std::vector<const Polygon*> wanted;
    for (const Polygon& polygon : polygons) {
        if (number_of(polygon) <= number) continue;
        copy.more = wanted.size() == limit;
        if (copy.more) break;
        wanted.push_back(&polygon);
    }
    if (wanted.empty()) return copy;
    const core::ConstraintHistory history(tin_);
    for (const Polygon* polygon : wanted)
        copy.polygons.push_back(drape(tin_, history, *polygon));
    return copy;
}

}  // namespace tinsmith::server
