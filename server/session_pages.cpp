// SPDX-License-Identifier: Apache-2.0
// A session's polygons by pages.
#include "core/regions/constraint_history.hpp"
#include "server/draping.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

DrapedCopy Session::draped_after(std::uint64_t number, std::size_t limit) const {
    const auto lock = lock_to_read();
    DrapedCopy copy{{}, version()};
    const std::vector<Polygon> polygons = history_.polygons();
    std::vector<const Polygon*> wanted;
    for (const Polygon& polygon : polygons) {
        if (polygon.number() <= number) continue;
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
