// SPDX-License-Identifier: Apache-2.0
// A session's mesh as it was.
#include <utility>

#include "core/integrate/integrator.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

VersionOutcome Session::tin_at(std::uint64_t wanted, const RunLimits& limits) const {
    auto lock = lock_to_read();
    if (wanted == 0 || wanted > version()) return VersionAhead{version()};
    auto way = history_.way_to(wanted);
    if (const auto* gone = std::get_if<VersionGone>(&way)) return *gone;
    core::Tin tin = tin_;
    lock.unlock();
    const auto& [taken, again] = std::get<WayBack>(way);
    for (auto applied = taken.rbegin(); applied != taken.rend(); ++applied)
        core::take_back(tin, (*applied)->undo);
    for (std::size_t i = 0; i < again.size(); ++i) {
        auto applied =
            run(tin, again[i].version, again[i].operation, limits_of_part(limits, i, again.size()));
        if (!applied) return std::move(applied.errors());
    }
    return tin;
}

std::variant<std::monostate, VersionGone, VersionAhead> Session::missing(
    std::uint64_t wanted) const {
    const auto lock = lock_to_read();
    if (wanted == 0 || wanted > version()) return VersionAhead{version()};
    const auto way = history_.way_to(wanted);
    if (const auto* gone = std::get_if<VersionGone>(&way)) return *gone;
    return std::monostate{};
}

}  // namespace tinsmith::server
